// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

const CREASE_COS = Math.cos((32 * Math.PI) / 180);

/** Unit normals of triangles, 3 numbers each. */
function triangleNormals(points, triangles) {
  const normals = new Float32Array(triangles.length);
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
    const u = [0, 1, 2].map((k) => points[b + k] - points[a + k]);
    const v = [0, 1, 2].map((k) => points[c + k] - points[a + k]);
    const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    normals.set(n.map((x) => x / (Math.hypot(...n) || 1)), t);
  }
  return normals;
}

function cosine(normals, s, t) {
  return normals[3 * s] * normals[3 * t] + normals[3 * s + 1] * normals[3 * t + 1] +
    normals[3 * s + 2] * normals[3 * t + 2];
}

/** For each edge, both of its nodes and its triangles. */
function findEdges(triangles) {
  const edges = new Map();
  for (let corner = 0; corner < triangles.length; ++corner) {
    const t = Math.floor(corner / 3);
    const a = triangles[corner];
    const b = triangles[3 * t + ((corner + 1) % 3)];
    const key = a < b ? `${a},${b}` : `${b},${a}`;
    if (!edges.has(key)) edges.set(key, { a, b, triangles: [] });
    edges.get(key).triangles.push(t);
  }
  return [...edges.values()];
}

/**
 * The surface for shading: nodes at creases are doubled, so that each side has its own normal.
 * @param {Float32Array} points rest positions, 3 for each node
 * @param {Uint32Array} triangles
 * @returns {{source: Uint32Array, index: Uint32Array, edges: Uint32Array, creases: Uint32Array}}
 *     source: node of each drawn vertex; index, edges and creases count drawn vertices
 */
export function splitAtCreases(points, triangles) {
  const normals = triangleNormals(points, triangles);
  const edges = findEdges(triangles);
  // Corners of one node that are joined over smooth edges are one drawn vertex (union-find).
  const parent = Uint32Array.from(triangles, (_, corner) => corner);
  const root = (corner) => {
    while (parent[corner] !== corner) corner = parent[corner] = parent[parent[corner]];
    return corner;
  };
  const cornerOf = (t, node) => 3 * t + [0, 1, 2].find((k) => triangles[3 * t + k] === node);
  const isCrease = ({ triangles: [s, t] }) =>
    t === undefined || cosine(normals, s, t) < CREASE_COS;
  for (const edge of edges) {
    if (isCrease(edge)) continue;
    for (const node of [edge.a, edge.b]) {
      const [s, t] = edge.triangles.map((triangle) => root(cornerOf(triangle, node)));
      parent[s] = t;
    }
  }
  const vertex_of_root = new Map();
  const source = [];
  const index = Uint32Array.from(triangles, (node, corner) => {
    const key = root(corner);
    if (!vertex_of_root.has(key)) vertex_of_root.set(key, source.push(node) - 1);
    return vertex_of_root.get(key);
  });
  const ends = ({ a, b, triangles: [t] }) => [index[cornerOf(t, a)], index[cornerOf(t, b)]];
  return {
    source: Uint32Array.from(source),
    index,
    edges: Uint32Array.from(edges.filter((edge) => !isCrease(edge)).flatMap(ends)),
    creases: Uint32Array.from(edges.filter(isCrease).flatMap(ends)),
  };
}
