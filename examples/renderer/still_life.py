#!/usr/bin/env python3
"""Writes still_life.glb: a small scene with something of most that a renderer has to draw. Needs nothing beside Python.

A coated vase in two variants, stalks that a skin bends, flowers that morph, leaves with alpha masks, a glass ball and a frosted
block, a soap bubble that is blended, pebbles in instances, a lamp whose strength an animation pointer changes.
"""
import json
import math
import struct
import sys
import zlib

TAU = 2 * math.pi


class File:
    """The glTF file as it grows: its JSON, and the bytes behind it."""

    def __init__(self):
        self.binary = bytearray()
        self.json = {"asset": {"version": "2.0", "generator": "still_life.py"}, "bufferViews": [], "accessors": [],
                     "meshes": [], "nodes": [], "materials": [], "textures": [], "images": [], "samplers": [{}]}

    def add(self, kind, item):
        self.json.setdefault(kind, []).append(item)
        return len(self.json[kind]) - 1

    def view(self, data, **more):
        self.binary += bytes(-len(self.binary) % 4)
        view = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data), **more}
        self.binary += data
        return self.add("bufferViews", view)

    def accessor(self, rows, kind="f", bounds=False, **more):
        """Rows of equal length; kind: f, b (normalized bytes), H (normalized shorts), I, B (plain bytes)."""
        width = len(rows[0])
        scale = {"f": None, "b": 127, "H": 65535}.get(kind)
        pad = bytes(-width * struct.calcsize("<" + kind) % 4)
        def packed(row):
            numbers = row if scale is None else [round(max(-1.0, min(1.0, x)) * scale) for x in row]
            return struct.pack(f"<{width}{kind}", *numbers) + pad
        data = b"".join(map(packed, rows))
        stride = {"byteStride": len(data) // len(rows)} if pad or more.pop("vertices", False) else {}
        accessor = {"bufferView": self.view(data, **stride), "count": len(rows),
                    "componentType": {"f": 5126, "b": 5120, "B": 5121, "H": 5123, "I": 5125}[kind],
                    "type": {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}[width]}
        if scale is not None:
            accessor["normalized"] = True
        if bounds:
            single = [struct.unpack(f"<{width}f", struct.pack(f"<{width}f", *row)) for row in rows]
            accessor["min"] = [min(column) for column in zip(*single)]
            accessor["max"] = [max(column) for column in zip(*single)]
        return self.add("accessors", accessor)

    def indices(self, triangles):
        data = struct.pack(f"<{3 * len(triangles)}H", *[i for triangle in triangles for i in triangle])
        view = self.view(data)
        return self.add("accessors", {"bufferView": view, "componentType": 5123, "count": 3 * len(triangles), "type": "SCALAR"})

    def texture(self, width, height, color):
        """A PNG; color(u, v) gives three or four numbers from 0 to 1."""
        rows = b""
        for y in range(height):
            rows += b"\0" + b"".join(bytes(round(255 * max(0.0, min(1.0, c))) for c in color((x + 0.5) / width, (y + 0.5) / height))
                                     for x in range(width))
        channels = len(color(0.5, 0.5))
        def chunk(name, data):
            return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        png = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2 if channels == 3 else 6, 0, 0, 0))
        png += chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")
        image = self.add("images", {"bufferView": self.view(png), "mimeType": "image/png"})
        return {"index": self.add("textures", {"source": image, "sampler": 0})}

    def material(self, name, color=(1, 1, 1, 1), metal=0.0, rough=1.0, extensions=None, **more):
        pbr = {"baseColorFactor": list(color), "metallicFactor": metal, "roughnessFactor": rough}
        pbr.update(more.pop("pbr", {}))
        material = {"name": name, "pbrMetallicRoughness": pbr, **more}
        if extensions:
            material["extensions"] = extensions
        return self.add("materials", material)

    def mesh(self, shape, material, **more):
        """A shape is a list of (position, normal, uv) and one of triangles."""
        vertices, triangles = shape
        attributes = {"POSITION": self.accessor([v[0] for v in vertices], bounds=True, vertices=True),
                      "NORMAL": self.accessor([v[1] for v in vertices], "b"),
                      "TEXCOORD_0": self.accessor([v[2] for v in vertices], "H", vertices=True)}
        primitive = {"attributes": attributes, "indices": self.indices(triangles), "material": material, **more}
        return self.add("meshes", {"primitives": [primitive]})

    def bytes(self):
        self.binary += bytes(-len(self.binary) % 4)
        self.json["buffers"] = [{"byteLength": len(self.binary)}]
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(self.binary), 0x004E4942) + self.binary
        return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def unit(v):
    size = math.sqrt(sum(x * x for x in v)) or 1.0
    return [x / size for x in v]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def surface(point, columns, rows):
    """point(u, v) over a grid; normals by differences, outwards where u turns to the left seen from above."""
    step = 1e-4
    vertices = []
    for j in range(rows + 1):
        for i in range(columns + 1):
            u, v = i / columns, j / rows
            low, high = max(v - step, 0.0), min(v + step, 1.0)
            along = [b - a for a, b in zip(point(u - step, v), point(u + step, v))]
            if sum(x * x for x in along) < 1e-16:  # a pole: as its neighbours
                inner = 0.01 if v < 0.5 else 0.99
                along = [b - a for a, b in zip(point(u - step, inner), point(u + step, inner))]
            up = [b - a for a, b in zip(point(u, low), point(u, high))]
            vertices.append((point(u, v), unit(cross(along, up)), [u, v]))
    triangles = []
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i
            b = a + columns + 1
            triangles += [(a, a + 1, b + 1), (a, b + 1, b)]
    def area(t):
        p, q, r = (vertices[k][0] for k in t)
        return sum(x * x for x in cross([b - a for a, b in zip(p, q)], [b - a for a, b in zip(p, r)]))
    return vertices, [t for t in triangles if area(t) > 1e-18]


def lathe(profile, columns, rows):
    """profile(v) is (radius, height), from below to above along the outside."""
    def point(u, v):
        radius, height = profile(v)
        return [radius * math.cos(TAU * u), height, -radius * math.sin(TAU * u)]
    return surface(point, columns, rows)


def ball(radius, columns=32, rows=16, bump=lambda u, v: 1.0):
    def point(u, v):
        r = radius * bump(u % 1.0, v)
        ring = r * math.sin(math.pi * v)
        return [ring * math.cos(TAU * u), -r * math.cos(math.pi * v), -ring * math.sin(TAU * u)]
    return surface(point, columns, rows)


def spline(points):
    """A smooth curve through points, from 0 to 1 (Catmull-Rom)."""
    def at(v):
        x = max(0.0, min(1.0, v)) * (len(points) - 1)
        i = min(int(x), len(points) - 2)
        t = x - i
        p = [points[max(0, min(len(points) - 1, k))] for k in (i - 1, i, i + 1, i + 2)]
        return [0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t + (3 * b - a - 3 * c + d) * t ** 3)
                for a, b, c, d in zip(*p)]
    return at


def hashed(i, k):
    return (math.sin(i * 12.9898 + k * 78.233) * 43758.5453) % 1.0


def turn(axis, angle):
    s = math.sin(angle / 2)
    return [axis[0] * s, axis[1] * s, axis[2] * s, math.cos(angle / 2)]


def main():
    f = File()
    scene = []

    def place(mesh, at, **more):
        scene.append(f.add("nodes", {"mesh": mesh, "translation": list(at), **more}))
        return scene[-1]

    # A round table of wood.
    def wood(u, v):
        ring = math.hypot(u - 0.42, (v - 0.5) * 0.35) * 46 + 0.7 * math.sin(9 * v) + 0.35 * math.sin(31 * v + 5 * u)
        dark = 0.5 + 0.5 * math.sin(ring * 2.2)
        grain = 0.06 * hashed(int(u * 64) * 3, int(v * 8))
        return [0.50 - 0.16 * dark + grain, 0.31 - 0.12 * dark + grain, 0.17 - 0.07 * dark + grain]
    table = f.material("Wood", rough=0.42, pbr={"baseColorTexture": f.texture(96, 96, wood)})
    edge = spline([(3.6, -0.3), (3.72, -0.2), (3.72, -0.08), (3.6, 0.0)])
    top, sides = lathe(lambda v: edge(v), 64, 6)
    first = len(top)
    top.append(([0, 0, 0], [0, 1, 0], [0.5, 0.5]))
    for i in range(65):
        angle = TAU * i / 64
        top.append(([3.6 * math.cos(angle), 0, -3.6 * math.sin(angle)], [0, 1, 0],
                    [0.5 + 0.5 * math.cos(angle), 0.5 - 0.5 * math.sin(angle)]))
    sides += [(first, first + 1 + i, first + 2 + i) for i in range(64)]
    place(f.mesh((top, sides), table), (0, 0, 0))

    # A vase in a coat of lacquer, red or green.
    coat = {"KHR_materials_coat": {"coatFactor": 1, "coatRoughnessFactor": 0.04, "coatColorFactor": [1.0, 0.62, 0.5]}}
    red = f.material("Red lacquer", (0.62, 0.04, 0.03, 1), 0.0, 0.55, coat, doubleSided=True)
    green = f.material("Green lacquer", (0.03, 0.30, 0.20, 1), 0.35, 0.45,
                       {"KHR_materials_coat": {"coatFactor": 1, "coatRoughnessFactor": 0.08, "coatColorFactor": [0.7, 1.0, 0.8]}},
                       doubleSided=True)
    vase = lathe(spline([(0.0, 0.0), (0.42, 0.0), (0.62, 0.28), (0.72, 0.68), (0.58, 1.12), (0.34, 1.45), (0.30, 1.66),
                         (0.42, 1.84), (0.40, 1.86), (0.27, 1.66), (0.25, 1.5)]), 40, 40)
    variants = {"KHR_materials_variants": {"mappings": [{"material": red, "variants": [0]}, {"material": green, "variants": [1]}]}}
    place(f.mesh(vase, red, extensions=variants), (-0.35, 0, -0.25))
    f.json["extensions"] = {"KHR_materials_variants": {"variants": [{"name": "red"}, {"name": "green"}]}}

    # Three stalks in it, one mesh: each hangs on a chain of four joints.
    stalk_length, links = 1.5, 4
    leaf_green = f.material("Stalk", (0.12, 0.30, 0.06, 1), 0.0, 0.6)
    vertices, triangles, joints, weights, nodes, binds, chains = [], [], [], [], [], [], []
    for s in range(3):
        radius = lambda v: 0.035 * (1.15 - 0.5 * v)
        shape, faces = surface(lambda u, v: [radius(v) * math.cos(TAU * u), stalk_length * v, -radius(v) * math.sin(TAU * u)], 10, 20)
        base = len(vertices)
        for position, normal, uv in shape:
            along = min(position[1] / stalk_length * links, links - 1e-6)
            k, t = int(along), along - int(along)
            vertices.append((position, normal, uv))
            joints.append([links * s + k, min(links * s + k + 1, links * s + links - 1), 0, 0])
            weights.append([1 - t, t, 0, 0])
        triangles += [tuple(base + i for i in face) for face in faces]
        chain = []
        for k in range(links):
            # At rest they lean outwards, each to its own side.
            lean = 0.16 + 0.05 * s
            axis = unit([math.sin(2.1 * s + 0.6), 0, math.cos(2.1 * s + 0.6)])
            node = {"translation": [-0.35, 1.35, -0.25] if k == 0 else [0, stalk_length / links, 0],
                    "rotation": turn(axis, lean * (0.6 if k == 0 else 1.0))}
            chain.append(f.add("nodes", node))
            binds.append([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -stalk_length * k / links, 0, 1])
        for parent, child in zip(chain, chain[1:]):
            f.json["nodes"][parent]["children"] = [child]
        scene.append(chain[0])
        chains.append(chain)
        nodes += chain
    stalks = f.mesh((vertices, triangles), leaf_green)
    attributes = f.json["meshes"][stalks]["primitives"][0]["attributes"]
    attributes["JOINTS_0"] = f.accessor(joints, "B")
    attributes["WEIGHTS_0"] = f.accessor(weights)
    skin = f.add("skins", {"joints": nodes, "inverseBindMatrices": f.accessor(binds)})
    scene.append(f.add("nodes", {"mesh": stalks, "skin": skin}))

    # A flower at the end of each: open, and closed as a morph target.
    def petals(spread):
        def point(u, v):
            lobe = 0.72 + 0.28 * math.cos(5 * TAU * u)
            out = spread * (0.04 + 0.34 * v ** 0.8 * (lobe if v > 0.2 else 1 - (1 - lobe) * v / 0.2))
            return [out * math.cos(TAU * u), 0.30 * v * (1.25 - 0.75 * spread) + 0.05 * spread * math.sin(math.pi * v), -out * math.sin(TAU * u)]
        return surface(point, 40, 6)
    # An outside and an inside, so that light has a front on both.
    petal = f.material("Petals", (0.90, 0.55, 0.10, 1), 0.0, 0.7, {"KHR_materials_sheen": {"sheenColorFactor": [0.5, 0.3, 0.1], "sheenRoughnessFactor": 0.4}}, doubleSided=True)
    opened, closed = petals(1.0), petals(0.28)
    flower = f.mesh(opened, petal)
    primitive = f.json["meshes"][flower]["primitives"][0]
    delta = lambda k: [[b - a for a, b in zip(p[k], q[k])] for p, q in zip(opened[0], closed[0])]
    primitive["targets"] = [{"POSITION": f.accessor(delta(0), bounds=True, vertices=True), "NORMAL": f.accessor(delta(1), vertices=True)}]
    f.json["meshes"][flower]["weights"] = [0.0]
    heart = f.mesh(ball(0.075, 16, 8), f.material("Heart", (0.25, 0.10, 0.02, 1), 0.0, 0.9))
    flowers = []
    for chain in chains:
        flowers.append(f.add("nodes", {"mesh": flower, "translation": [0, stalk_length / links, 0]}))
        inside = f.add("nodes", {"mesh": heart, "translation": [0, stalk_length / links + 0.03, 0]})
        f.json["nodes"][chain[-1]]["children"] = [flowers[-1], inside]

    # Leaves: cards whose outline is an alpha mask.
    def leaf(u, v):
        half = 0.46 * math.sin(math.pi * min(1.0, v * 1.02)) ** 0.8 * (1.0 - 0.25 * v)
        rib = abs(u - 0.5) < 0.03 or abs((abs(u - 0.5) * 1.4 - v * 2) % 0.35) < 0.05
        inside = abs(u - 0.5) < half
        return [0.10 + 0.10 * rib, 0.34 + 0.12 * rib, 0.06 + 0.03 * rib, 1.0 if inside else 0.0]
    masked = f.material("Leaves", rough=0.55, alphaMode="MASK", doubleSided=True, pbr={"baseColorTexture": f.texture(48, 96, leaf)})
    card = surface(lambda u, v: [0.36 * (u - 0.5), 0.85 * v, -0.35 * v * v + 0.03 * math.cos(TAU * u)], 4, 8)
    card_mesh = f.mesh(card, masked)
    for i, chain in enumerate(chains):
        for k in range(2):
            node = f.add("nodes", {"mesh": card_mesh, "translation": [0, 0.1 + 0.15 * k, 0], "scale": [0.75] * 3,
                                   "rotation": turn([0, 1, 0], 2.0 * i + 2.6 * k)})
            f.json["nodes"][chain[1 if k == 0 else 2]].setdefault("children", []).append(node)

    # Glass: a ball of bottle green, and a frosted block.
    glass = {"KHR_materials_transmission": {"transmissionFactor": 1.0},
             "KHR_materials_volume": {"thicknessFactor": 1.1, "attenuationDistance": 1.3, "attenuationColor": [0.35, 0.85, 0.75]},
             "KHR_materials_ior": {"ior": 1.5}}
    place(f.mesh(ball(0.55, 48, 24), f.material("Glass", rough=0.0, extensions=glass)), (1.15, 0.55, 0.55))
    frost = {"KHR_materials_transmission": {"transmissionFactor": 1.0},
             "KHR_materials_volume": {"thicknessFactor": 0.5, "attenuationDistance": 1.0, "attenuationColor": [0.95, 0.75, 0.55]},
             "KHR_materials_ior": {"ior": 1.45}}
    corners = [(-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1), (-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1)]
    block = ([], [])
    for face, normal in (((0, 1, 2, 3), (0, 0, 1)), ((5, 4, 7, 6), (0, 0, -1)), ((1, 5, 6, 2), (1, 0, 0)),
                         ((4, 0, 3, 7), (-1, 0, 0)), ((3, 2, 6, 7), (0, 1, 0)), ((4, 5, 1, 0), (0, -1, 0))):
        n = len(block[0])
        block[0].extend(([0.42 * corners[k][0], 0.62 * corners[k][1], 0.16 * corners[k][2]], list(normal), list(uv))
                        for k, uv in zip(face, ((0, 1), (1, 1), (1, 0), (0, 0))))
        block[1].extend([(n, n + 1, n + 2), (n, n + 2, n + 3)])
    place(f.mesh(block, f.material("Frosted glass", rough=0.32, extensions=frost)), (-1.75, 0.62, 0.55), rotation=turn([0, 1, 0], 0.5))

    # A ring of brushed gold.
    def ring(u, v):
        radius = 0.40 + 0.13 * math.cos(TAU * v)
        return [radius * math.cos(TAU * u), -0.13 * math.sin(TAU * v), radius * math.sin(TAU * u)]
    gold = f.material("Gold", (1.0, 0.76, 0.34, 1), 1.0, 0.28, {"KHR_materials_anisotropy": {"anisotropyStrength": 0.6}})
    place(f.mesh(surface(ring, 40, 16), gold), (0.45, 0.13, 1.55))

    # A bubble, blended.
    bubble = f.material("Bubble", (0.9, 0.95, 1.0, 0.18), 0.0, 0.03, {"KHR_materials_iridescence": {
        "iridescenceFactor": 1.0, "iridescenceIor": 1.33, "iridescenceThicknessMaximum": 480}}, alphaMode="BLEND")
    bubble_node = place(f.mesh(ball(0.30, 32, 16), bubble), (1.55, 1.75, -0.25))

    # A lamp: a bulb whose strength changes, with a light in it.
    bulb = f.material("Bulb", (0.02, 0.02, 0.02, 1), 0.0, 0.4, {"KHR_materials_emissive_strength": {"emissiveStrength": 5.0}},
                      emissiveFactor=[1.0, 0.72, 0.38])
    brass = f.material("Brass", (0.85, 0.62, 0.30, 1), 1.0, 0.35)
    stand = lathe(spline([(0.0, 0.0), (0.30, 0.0), (0.30, 0.05), (0.06, 0.10), (0.045, 0.6), (0.045, 1.05), (0.12, 1.12), (0.12, 1.18), (0.0, 1.19)]), 24, 32)
    place(f.mesh(stand, brass), (1.75, 0, -1.35))
    place(f.mesh(ball(0.20, 24, 12), bulb), (1.75, 1.36, -1.35))

    # Pebbles, one mesh many times.
    pebble = f.mesh(ball(0.10, 14, 8, lambda u, v: 1 + 0.08 * math.sin(TAU * u * 2) * math.sin(math.pi * v)),
                    f.material("Pebbles", (0.30, 0.29, 0.28, 1), 0.0, 0.75))
    at, turns, sizes = [], [], []
    for i in range(42):
        angle, radius = TAU * (0.53 + 0.33 * hashed(i, 1)), 1.55 + 1.3 * hashed(i, 2)
        size = 0.5 + 1.0 * hashed(i, 3)
        at.append([radius * math.cos(angle), 0.055 * size, -radius * math.sin(angle)])
        turns.append(turn([0, 1, 0], TAU * hashed(i, 4)))
        sizes.append([size * (0.8 + 0.6 * hashed(i, 5)), size * 0.6, size])
    instancing = {"attributes": {"TRANSLATION": f.accessor(at), "ROTATION": f.accessor(turns), "SCALE": f.accessor(sizes)}}
    scene.append(f.add("nodes", {"mesh": pebble, "extensions": {"EXT_mesh_gpu_instancing": instancing}}))

    # A sun that casts shadows, the lamp's light, and a camera.
    f.json["extensions"]["KHR_lights_punctual"] = {"lights": [
        {"type": "directional", "color": [1.0, 0.95, 0.86], "intensity": 4.2},
        {"type": "point", "color": [1.0, 0.72, 0.38], "intensity": 2.4, "range": 12}]}
    sun = turn(unit([-1, 0, 0]), 0.80)
    heading = turn([0, 1, 0], -1.05)
    def product(a, b):
        return [a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1], a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
                a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3], a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]]
    scene.append(f.add("nodes", {"rotation": product(heading, sun), "extensions": {"KHR_lights_punctual": {"light": 0}}}))
    scene.append(f.add("nodes", {"translation": [1.75, 1.36, -1.35], "extensions": {"KHR_lights_punctual": {"light": 1}}}))
    camera = f.add("cameras", {"type": "perspective", "perspective": {"yfov": 0.56, "znear": 0.1, "zfar": 60}})
    scene.append(f.add("nodes", {"camera": camera, "translation": [0.9, 2.75, 7.6],
                                 "rotation": product(turn([0, 1, 0], 0.105), turn([1, 0, 0], -0.205))}))

    # Four seconds: the stalks sway, the flowers close and open, the bubble rises and falls, the lamp dims.
    times = f.accessor([[t] for t in (0.0, 1.0, 2.0, 3.0, 4.0)], bounds=True)
    channels, samplers = [], []
    def animate(output, target, interpolation="LINEAR"):
        samplers.append({"input": times, "output": output, "interpolation": interpolation})
        channels.append({"sampler": len(samplers) - 1, "target": target})
    for s, chain in enumerate(chains):
        for k in range(1, links):
            rest = f.json["nodes"][chain[k]]["rotation"]
            keys = [product(rest, turn([1, 0, 0.3], 0.10 * math.sin(TAU * t / 4 + s + 0.4 * k))) for t in range(5)]
            animate(f.accessor([unit(key) for key in keys]), {"node": chain[k], "path": "rotation"})
        animate(f.accessor([[0.12 * s], [0.5], [0.95], [0.5], [0.12 * s]]), {"node": flowers[s], "path": "weights"})
    rising = [row for y in (1.75, 1.95, 2.1, 1.95, 1.75) for row in ([0, 0, 0], [1.55, y, -0.25], [0, 0, 0])]
    animate(f.accessor(rising), {"node": bubble_node, "path": "translation"}, "CUBICSPLINE")
    strength = f"/materials/{bulb}/extensions/KHR_materials_emissive_strength/emissiveStrength"
    animate(f.accessor([[5.0], [2.5], [0.6], [2.5], [5.0]]),
            {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": strength}}})
    animate(f.accessor([[2.4], [1.2], [0.3], [1.2], [2.4]]), {"path": "pointer", "extensions": {"KHR_animation_pointer": {
        "pointer": "/extensions/KHR_lights_punctual/lights/1/intensity"}}})
    f.json["animations"] = [{"channels": channels, "samplers": samplers}]

    f.json["scenes"] = [{"nodes": scene}]
    f.json["scene"] = 0
    used = {"KHR_materials_variants", "KHR_lights_punctual", "EXT_mesh_gpu_instancing", "KHR_animation_pointer", "KHR_mesh_quantization"}
    for material in f.json["materials"]:
        used.update(material.get("extensions", {}))
    f.json["extensionsUsed"] = sorted(used)
    f.json["extensionsRequired"] = ["KHR_mesh_quantization"]
    with open(sys.argv[1], "wb") as out:
        out.write(f.bytes())


if __name__ == "__main__":
    main()
