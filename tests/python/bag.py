#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The palpate authors
# SPDX-License-Identifier: Apache-2.0
"""Messages of ROS 2 in a .db3 file of rosbag2, from arrays."""

import sqlite3
import struct


class Cdr:
    """Little-endian CDR (XCDR1), piece by piece."""

    def __init__(self):
        self.data = bytearray(b"\0\1\0\0")

    def put(self, kind, *numbers):
        size = struct.calcsize("<" + kind)
        for number in numbers:
            self.data += b"\0" * (-(len(self.data) - 4) % size)
            self.data += struct.pack("<" + kind, number)
        return self

    def text(self, text):
        self.put("I", len(text) + 1)
        self.data += text.encode() + b"\0"
        return self

    def blob(self, data):
        self.put("I", len(data))
        self.data += data
        return self

    def header(self, t_ns, frame):
        return self.put("i", t_ns // 10**9).put("I", t_ns % 10**9).text(frame)


def image(t_ns, frame, pixels, encoding):
    height, width = pixels.shape[:2]
    return (Cdr().header(t_ns, frame).put("I", height, width).text(encoding).put("B", 0)
            .put("I", pixels.nbytes // height).blob(pixels.tobytes()))


def camera_info(t_ns, frame, camera):
    K = [float(number) for number in camera.K.ravel()]
    one = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
    P = [*K[0:3], 0.0, *K[3:6], 0.0, *K[6:9], 0.0]
    return (Cdr().header(t_ns, frame).put("I", camera.height_px, camera.width_px)
            .text("plumb_bob").put("I", 5).put("d", *camera.distortion, *K, *one, *P)
            .put("I", 0, 0, 0, 0, 0, 0).put("B", 0))


def transform(parent, child, translation_m, rotation_xyzw):
    return (Cdr().put("I", 1).header(0, parent).text(child)
            .put("d", *translation_m, *rotation_xyzw))


def write_db3(path, messages):
    """`messages`: topic, type, time in ns, Cdr."""
    with sqlite3.connect(path) as database:
        database.execute(
            "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
            "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)")
        database.execute(
            "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
            "timestamp INTEGER NOT NULL, data BLOB NOT NULL)")
        topics = {}
        for topic, kind, t_ns, cdr in messages:
            if topic not in topics:
                topics[topic] = len(topics) + 1
                database.execute("INSERT INTO topics VALUES (?, ?, ?, 'cdr', '')",
                                 (topics[topic], topic, kind))
            database.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)",
                             (topics[topic], t_ns, bytes(cdr.data)))
    database.close()
