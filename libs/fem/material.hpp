// SPDX-FileCopyrightText: 2026 The palpate authors
// SPDX-License-Identifier: Apache-2.0

#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace palpate::fem {

/// The stress that defines each material, with the Lame constants lambda and mu, E the Green
/// strain, F = R S the polar decomposition, J = det F, I = J^(-2/3) tr C:
enum class MaterialModel {
  kLinear,             ///< small strain: P = 2 mu eps + lambda tr(eps) I
  kCorotational,       ///< P = 2 mu (F - R) + lambda tr(R'F - I) R, exact tangent
  kStVenantKirchhoff,  ///< S = 2 mu E + lambda tr(E) I
  kNeoHookean,         ///< S = mu (I - C^-1) + lambda ln(J) C^-1
  kStableNeoHookean,  ///< S = mu I + (lambda + mu) J (J - alpha) C^-1, alpha = 1 + mu/(lambda + mu)
  /// S = 2 W' J^(-2/3) (I - tr C / 3 C^-1) + K (J - 1) J C^-1, K = lambda + 2/3 mu, from the energy
  /// W + K/2 (J - 1)^2, W = C10 (I - 3) + C20 (I - 3)^2 + C30 (I - 3)^3, C10 = mu / 2 (O. H. Yeoh,
  /// Some forms of the strain energy function for rubber, Rubber Chem. Technol. 66, 1993).
  kYeoh,
};

/// How the volumetric part sees the volume change of an element.
enum class Volumetric {
  kPointwise,  ///< J of each integration point
  /// Against locking of tet10 near nu = 0.5: (lambda - mu) U(mean J of the element) + mu U(J)
  /// instead of lambda U(J).
  kMeanDilatation,
};

struct Material {
  MaterialModel model = MaterialModel::kStableNeoHookean;
  Volumetric volumetric = Volumetric::kPointwise;
  double youngs_modulus_Pa = 0.0;  ///< > 0; bound to the mesh and element it was found with
  double poissons_ratio = 0.0;     ///< in (-1, 0.5)
  /// Yeoh: C20 / C10 and C30 / C10. E is that of small strains, C10 = E / (4 (1 + nu)), and all
  /// constants grow with it.
  double c20_over_c10 = 0.0;
  double c30_over_c10 = 0.0;

  double LameLambda_Pa() const {
    return youngs_modulus_Pa * poissons_ratio /
           ((1.0 + poissons_ratio) * (1.0 - 2.0 * poissons_ratio));
  }
  double LameMu_Pa() const { return youngs_modulus_Pa / (2.0 * (1.0 + poissons_ratio)); }
};

/// Names as robot files spell them: linear, corotational, st_venant_kirchhoff, neo_hookean,
/// stable_neo_hookean, yeoh.
std::string_view ToString(MaterialModel model);
/// pointwise, mean_dilatation
std::string_view ToString(Volumetric volumetric);
/// The model of that name; false where there is none.
bool ParseMaterialModel(std::string_view name, MaterialModel* model);
std::vector<std::string> MaterialModelNames();

/// True where W of the Yeoh material grows with I everywhere: shear never softens to nothing.
bool IsYeohMonotone(double c20_over_c10, double c30_over_c10);

}  // namespace palpate::fem
