#!/usr/bin/env python3
"""Writes the meshes and textures of the scenes in this folder, always the same bytes.

Standard library only. Run it without arguments from anywhere; it overwrites meshes/ and textures/ beside itself.
Lengths are metres, y is up. Random choices come from a fixed linear congruential generator, and nothing is compressed,
so the files do not depend on the version of Python or zlib.
"""

import math
import struct
import zlib
from pathlib import Path

HERE = Path(__file__).resolve().parent


# ---------------------------------------------------------------------------------------------------- small vectors


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def scaled(a, s):
    return tuple(x * s for x in a)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return scaled(a, 1 / math.sqrt(sum(x * x for x in a)))


class Random:
    """Uniform numbers in [0, 1) from Knuth's 64-bit MMIX generator."""

    def __init__(self, seed):
        self.state = seed

    def __call__(self):
        self.state = (self.state * 6364136223846793005 + 1442695040888963407) % 2**64
        return (self.state >> 11) / 2**53


# ------------------------------------------------------------------------------------------------------ file formats


def write_obj(name, comment, vertices, faces):
    """Wavefront OBJ with positions only; faces index from 0."""
    lines = [f"# {line}" for line in comment]
    lines += ["v " + " ".join(f"{x:.6g}" for x in v) for v in vertices]
    lines += ["f " + " ".join(str(i + 1) for i in face) for face in faces]
    (HERE / "meshes" / name).write_text("\n".join(lines) + "\n")


def write_ply(name, comment, vertices, faces, normals=None):
    """Little-endian binary PLY of triangles, with vertex normals if given."""
    properties = ["x", "y", "z"] + (["nx", "ny", "nz"] if normals else [])
    header = ["ply", "format binary_little_endian 1.0", f"comment {comment}", f"element vertex {len(vertices)}"]
    header += [f"property float {p}" for p in properties]
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    data = bytearray(("\n".join(header) + "\n").encode())
    for i, v in enumerate(vertices):
        values = v + normals[i] if normals else v
        data += struct.pack(f"<{len(values)}f", *values)
    for face in faces:
        data += struct.pack("<B3i", 3, *face)
    (HERE / "meshes" / name).write_bytes(data)


def write_serialized(name, meshes):
    """Mitsuba 0.6 serialized format, version 4: per mesh (label, vertices, normals, uvs, faces), floats."""
    has_normals, has_texcoords, single_precision = 0x0001, 0x0002, 0x1000
    data, offsets = bytearray(), []
    for label, vertices, normals, uvs, faces in meshes:
        body = struct.pack("<I", has_normals | has_texcoords | single_precision) + label.encode() + b"\0"
        body += struct.pack("<QQ", len(vertices), len(faces))
        for table in (vertices, normals, uvs):
            body += b"".join(struct.pack(f"<{len(row)}f", *row) for row in table)
        body += b"".join(struct.pack("<3I", *face) for face in faces)
        offsets.append(len(data))
        data += struct.pack("<HH", 0x041C, 4) + zlib.compress(body, 0)
    data += b"".join(struct.pack("<Q", offset) for offset in offsets) + struct.pack("<I", len(offsets))
    (HERE / "meshes" / name).write_bytes(data)


def write_png(name, width, height, pixel):
    """8-bit PNG; pixel(x, y) gives an int (grey) or three (sRGB), y from the top."""
    grey = isinstance(pixel(0, 0), int)
    rows = bytearray()
    for y in range(height):
        rows.append(0)  # no row filter
        for x in range(width):
            value = pixel(x, y)
            rows += bytes([value] if grey else value)

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    header = struct.pack(">IIBBBBB", width, height, 8, 0 if grey else 2, 0, 0, 0)
    data = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(rows), 0))
    (HERE / "textures" / name).write_bytes(data + chunk(b"IEND", b""))


def write_hdr(name, width, height, pixel):
    """Radiance RGBE picture; pixel(x, y) gives linear RGB, y from the top. Runs are written as literals."""
    data = bytearray(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode())
    for y in range(height):
        row = []
        for x in range(width):
            rgb = pixel(x, y)
            mantissa, exponent = math.frexp(max(rgb))
            scale = mantissa * 256 / max(rgb) if max(rgb) > 1e-32 else 0
            row.append([int(c * scale) for c in rgb] + [exponent + 128 if scale else 0])
        data += struct.pack(">BBH", 2, 2, width)
        for channel in range(4):
            values = bytes(p[channel] for p in row)
            for start in range(0, width, 128):
                run = values[start : start + 128]
                data += bytes([len(run)]) + run
    (HERE / "textures" / name).write_bytes(data)


# ------------------------------------------------------------------------------------------------------------ meshes


def four_holes():
    """A plate of 3 x 3 in z = 0 with two large (0.5) and two small (0.06) square holes, as a grid of squares."""
    holes = [(-0.5, 0.5, 0.25), (0.5, -0.5, 0.25), (0.5, 0.5, 0.03), (-0.5, -0.5, 0.03)]  # centre, half side
    cuts = sorted({-1.5, 1.5} | {c + s * h for x, y, h in holes for c in (x, y) for s in (-1, 1)})
    n = len(cuts)
    vertices = [(x, y, 0) for y in cuts for x in cuts]
    faces = []
    for j in range(n - 1):
        for i in range(n - 1):
            x, y = (cuts[i] + cuts[i + 1]) / 2, (cuts[j] + cuts[j + 1]) / 2
            if all(max(abs(x - hx), abs(y - hy)) > h for hx, hy, h in holes):
                a = j * n + i
                faces.append((a, a + 1, a + n + 1, a + n))
    comment = ["Plate with two large and two small square holes, normal +z."]
    write_obj("four-holes.obj", comment, vertices, faces)


def slat():
    """One slat of a venetian blind: 2 long (z), 0.06 wide (x), bowed upwards by 4 mm."""
    vertices = []
    for i in range(7):
        x = -0.03 + 0.01 * i
        y = 0.004 * (1 - (x / 0.03) ** 2)
        vertices += [(x, y, -1), (x, y, 1)]
    faces = [(2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2) for i in range(6)]
    write_obj("slat.obj", ["Slat of a venetian blind, 2 x 0.06, bowed upwards."], vertices, faces)


def knot():
    """A trefoil knot, a tube of radius 0.16 that fits in the unit ball; its lowest point is y = -0.48."""
    around, along, radius = 12, 72, 0.16

    def centre(t):
        r = 0.55 + 0.22 * math.cos(3 * t)
        return (r * math.cos(2 * t), 0.32 * math.sin(3 * t), r * math.sin(2 * t))

    vertices, normals, faces = [], [], []
    for i in range(along):
        t = 2 * math.pi * i / along
        p = centre(t)
        tangent = unit(add(centre(t + 1e-4), scaled(centre(t - 1e-4), -1)))
        side = unit(cross(tangent, p))  # the knot winds about the origin, so p is never along the tangent
        up = cross(side, tangent)
        for j in range(around):
            phi = 2 * math.pi * j / around
            n = add(scaled(side, math.cos(phi)), scaled(up, math.sin(phi)))
            vertices.append(add(p, scaled(n, radius)))
            normals.append(n)
            a, b = i * around + j, i * around + (j + 1) % around
            c, d = ((i + 1) % along) * around + j, ((i + 1) % along) * around + (j + 1) % around
            faces += [(a, d, b), (a, c, d)]
    write_ply("knot.ply", "trefoil knot, radius of the tube 0.16", vertices, faces, normals)


def tree():
    """A bare tree, 2.2 high: every branch ends in three thinner ones; open tubes with five sides."""
    random = Random(20)
    vertices, faces = [], []

    def branch(base, axis, length, radius, level):
        side = unit(cross(axis, (0.3, 0.2, 0.93)))
        up = cross(side, axis)
        tip = add(base, scaled(axis, length))
        first = len(vertices)
        for end, r in ((base, radius), (tip, 0.7 * radius)):
            for j in range(5):
                phi = 2 * math.pi * j / 5
                ring = add(scaled(side, math.cos(phi)), scaled(up, math.sin(phi)))
                vertices.append(add(end, scaled(ring, r)))
        for j in range(5):
            a, b = first + j, first + (j + 1) % 5
            faces.extend([(a, a + 5, b + 5), (a, b + 5, b)])
        if level == 0:
            return
        turn = 2 * math.pi * random()
        for j in range(3):
            phi = turn + 2 * math.pi * (j + 0.4 * random()) / 3
            spread = 0.45 + 0.35 * random()
            ring = add(scaled(side, math.cos(phi)), scaled(up, math.sin(phi)))
            child = add(scaled(axis, math.cos(spread)), scaled(ring, math.sin(spread)))
            child = unit(add(child, (0, 0.12, 0)))  # branches turn towards the light
            start = add(base, scaled(axis, length * (1 - 0.25 * random() * (j > 0))))
            branch(start, child, length * (0.68 + 0.14 * random()), 0.62 * radius, level - 1)

    branch((0, -0.05, 0), unit((0.03, 1, 0.02)), 0.7, 0.06, 5)
    write_ply("tree.ply", "bare tree, 364 branches", vertices, faces)


def vase():
    """A lathed vase, 0.6 high, with normals and texture coordinates."""
    around, along = 32, 20

    def profile(v):
        return 0.14 + 0.1 * math.sin(2.6 * math.pi * v + 0.3) * (1 - 0.55 * v), 0.6 * v

    vertices, normals, uvs, faces = [], [], [], []
    for i in range(along + 1):
        v = i / along
        r, y = profile(v)
        slope = (profile(v + 1e-4)[0] - profile(v - 1e-4)[0]) / (profile(v + 1e-4)[1] - profile(v - 1e-4)[1])
        for j in range(around + 1):
            phi = 2 * math.pi * j / around
            vertices.append((r * math.cos(phi), y, r * math.sin(phi)))
            normals.append(unit((math.cos(phi), -slope, math.sin(phi))))
            uvs.append((j / around, v))
            if i < along and j < around:
                a = i * (around + 1) + j
                b = a + around + 1
                faces += [(a, b, b + 1), (a, b + 1, a + 1)]
    write_serialized("vase.serialized", [("vase", vertices, normals, uvs, faces)])


# ---------------------------------------------------------------------------------------------------------- textures


def textures():
    random = Random(7)
    phase = [2 * math.pi * random() for _ in range(8)]

    def byte(x):
        return max(0, min(255, round(255 * x)))

    def wood(x, y):
        u, v = 2 * math.pi * x / 64, 2 * math.pi * y / 64
        warp = 0.5 * math.sin(v + phase[0]) + 0.3 * math.sin(2 * v + u + phase[1])
        grain = 0.5 + 0.35 * math.sin(6 * u + 2 * warp + phase[2]) + 0.15 * math.sin(17 * u + 3 * warp + phase[3])
        return (byte(0.52 + 0.2 * grain), byte(0.34 + 0.16 * grain), byte(0.2 + 0.1 * grain))

    def quarters(x, y):
        # Every corner of the picture is different, so that a flip or a wrong wrap mode shows.
        colour = [[(200, 60, 50), (60, 150, 70)], [(60, 90, 190), (210, 180, 70)]][y // 16][x // 16]
        inner = (x % 16 - 8) ** 2 + (y % 16 - 8) ** 2 < 20
        return tuple(c // 3 for c in colour) if inner else colour

    def lace(x, y):
        u, v = (x % 16) / 16 - 0.5, (y % 16) / 16 - 0.5
        petal = 0.3 + 0.12 * math.cos(4 * math.atan2(v, u))
        return byte(0.5 + 12 * (math.hypot(u, v) - petal))

    def dimples(x, y):
        u, v = (x % 16 - 7.5) / 8, (y % 16 - 7.5) / 8
        return byte(min(1, u * u + v * v))

    write_png("wood.png", 64, 64, wood)
    write_png("quarters.png", 32, 32, quarters)
    write_png("lace.png", 64, 64, lace)
    write_png("dimples.png", 64, 64, dimples)

    def ramp(x, _):
        # From a dim blue to a bright red [charted-toy]: the intensity grows fourfold per quarter.
        t = (x + 0.5) / 32
        level = 0.1 * 4 ** (4 * t) / 4
        return (level * t, level * (0.15 + 0.5 * t * (1 - t)), level * (1 - t) ** 2)

    write_hdr("ramp.hdr", 32, 8, ramp)


def direction(x, y, width, height):
    """Direction of a texel of a latitude-longitude map: left edge -z, then +x, +z (middle), -x; top row +y."""
    phi, theta = 2 * math.pi * (x + 0.5) / width, math.pi * (y + 0.5) / height
    return (math.sin(theta) * math.sin(phi), math.cos(theta), -math.sin(theta) * math.cos(phi))


def lobe(w, axis, sharpness):
    return math.exp(sharpness * (sum(a * b for a, b in zip(w, unit(axis))) - 1))


def environments():
    def sky(x, y):
        w = direction(x, y, 128, 64)
        sun = 3000 * lobe(w, (0.45, 1, 0.25), 1500)
        if w[1] < 0:
            return (0.25, 0.22, 0.18)
        haze = (1 - w[1]) ** 3
        return (0.5 + 0.7 * haze + sun, 0.8 + 0.5 * haze + 0.9 * sun, 1.6 + 0.1 * haze + 0.7 * sun)

    def studio(x, y):
        w = direction(x, y, 64, 32)
        key, rim = 6 * lobe(w, (-1, 1.2, 1), 25), 4 * lobe(w, (1.2, 0.5, -0.6), 25)
        fill = 0.25 + 0.25 * max(0, w[1])
        return (fill + key + 0.5 * rim, fill + 0.93 * key + 0.7 * rim, fill * 1.15 + 0.8 * key + rim)

    write_hdr("sky.hdr", 128, 64, sky)
    write_hdr("studio.hdr", 64, 32, studio)


def main():
    for folder in ("meshes", "textures"):
        (HERE / folder).mkdir(exist_ok=True)
    four_holes()
    slat()
    knot()
    tree()
    vase()
    textures()
    environments()


if __name__ == "__main__":
    main()
