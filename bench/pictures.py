#!/usr/bin/env python3
"""A picture of every standard node, drawn by the program on the CPU.

    bench/pictures.py build/release/lacquer [--check]

Renews docs/standard-pictures.md and the sheets beside it, docs/images/standard-CATEGORY.png, the same bytes every time.
--check changes nothing and fails where the page is not what would be written. Each tile has the plane's coordinates from 0 to 1, a
ball's normals for what reads them, and ramps of hue and of grey for what takes colours and numbers.
"""

import argparse
import json
import math
import os
import struct
import subprocess
import sys
import tempfile
import zlib

TILE = 40       # pixels of a tile's side
COLUMNS = 12
MARGIN = 4
ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
PAGE = os.path.join(ROOT, "docs", "standard-pictures.md")
FOLDER = os.path.join(ROOT, "docs", "images")
WIDE = {"float": 1, "vec2": 2, "vec3": 3, "vec4": 4}
# One form is shown of each node: the first of these that it has.
PREFERRED = ("vec3", "vec3, float", "vec4", "float", "vec2")
# What shows a node better than its defaults.
BETTER = {
    "noise2d": {"texcoord": "uv8"}, "fractal2d": {"texcoord": "uv8"}, "cellnoise2d": {"texcoord": "uv8"},
    "worleynoise2d": {"texcoord": "uv8"}, "unifiednoise2d": {"freq": [8, 8]}, "noise3d": {"position": "p8"},
    "fractal3d": {"position": "p8"}, "cellnoise3d": {"position": "p8"}, "worleynoise3d": {"position": "p8"},
    "unifiednoise3d": {"freq": [8, 8, 8]}, "flake2d": {"size": 0.08, "coverage": 0.8}, "flake3d": {"size": 0.08, "coverage": 0.8, "position": "p1"},
    "circle": {"center": [0.5, 0.5], "radius": 0.4}, "cloverleaf": {"center": [0.5, 0.5], "radius": 0.4},
    "hexagon": {"center": [0.5, 0.5], "radius": 0.4},
    "line": {"center": [0, 0], "radius": 0.08, "point1": [0.2, 0.2], "point2": [0.8, 0.7]},
    "checkerboard": {"uvtiling": [4, 4]}, "grid": {"uvtiling": [4, 4], "thickness": 0.1}, "crosshatch": {"uvtiling": [4, 4], "thickness": 0.1},
    "tiledcircles": {"uvtiling": [3, 3]}, "tiledcloverleafs": {"uvtiling": [3, 3]}, "tiledhexagons": {"uvtiling": [3, 3]},
    "ramplr": {"valuel": [1, 0.3, 0], "valuer": [0, 0.4, 1]}, "ramptb": {"valuet": [1, 0.3, 0], "valueb": [0, 0.4, 1]},
    "splitlr": {"valuel": [1, 0.3, 0], "valuer": [0, 0.4, 1], "center": 0.5}, "splittb": {"valuet": [1, 0.3, 0], "valueb": [0, 0.4, 1], "center": 0.5},
    "ramp4": {"valuetl": [1, 0, 0], "valuetr": [1, 1, 0], "valuebl": [0, 0, 1], "valuebr": [0, 1, 0]},
    "ramp_gradient": {"x": "u", "interval1": 0, "interval2": 1, "color1": [1, 0.3, 0, 1], "color2": [0, 0.4, 1, 1], "num_intervals": 2},
    "randomcolor": {"in": "cells"}, "randomfloat": {"in": "cells"}, "constant": {"value": [0.9, 0.45, 0.1]},
}


def choose(forms):
    def rank(node):
        name = node["name"]
        types = name[name.index("<") + 1:-1] if "<" in name else ""
        result = node["outputs"][0]["type"]
        return (result not in WIDE, PREFERRED.index(types) if types in PREFERRED else len(PREFERRED), name)
    return min(forms, key=rank)


def source(kind, name):
    """What a tile feeds an input of a type with, where nothing says otherwise."""
    hue, grey = {"node": "hue"}, {"node": "uv", "output": "outx"}
    first = name in ("in", "fg", "in1", "value1", "value")
    if kind == "float":
        return grey if first else {"node": "uv", "output": "outy"}
    if kind == "vec2":
        return {"given": "uv0"}
    if kind == "vec3":
        return hue if first else {"node": "other"}
    if kind == "vec4":
        return {"node": "hue4"} if first else {"node": "other4"}
    return None


def graph_of(node):
    """A graph that shows a node, or None where it takes what no tile has."""
    family = node.get("family", node["name"])
    better = BETTER.get(family, {})
    inputs = {}
    textures = {}
    for index, param in enumerate(node["inputs"]):
        name, kind = param["name"], param["type"]
        if kind.startswith("sampler"):
            textures[name] = {"type": kind, "srgb": False}
            inputs[name] = {"texture": name}
        elif name in better:
            value = better[name]
            inputs[name] = {"node": value} if isinstance(value, str) else value
        elif name in ("geomprop", "varname"):
            inputs[name] = {"attribute": "_SHOWN", "type": kind}
        elif param.get("advanced") or param.get("given"):
            continue
        elif name == "in" or (name in ("fg", "bg", "in1", "in2", "value1") and kind in WIDE):
            made = source(kind, name)
            if made:
                inputs[name] = made
    number = {"bool": ("convert<float, bool>", "in"), "int": ("convert<float, int>", "in")}
    output = node["outputs"][0]
    result = output["type"]
    here = {"node": "n"} if len(node["outputs"]) == 1 else {"node": "n", "output": output["name"]}
    nodes = [
        {"id": "uv", "node": "separate2", "inputs": {"in": {"given": "uv0"}}},
        {"id": "u", "node": "dot<float>", "inputs": {"in": {"node": "uv", "output": "outx"}}},
        {"id": "hsv", "node": "combine3", "inputs": {"in1": {"node": "uv", "output": "outx"}, "in2": 0.8, "in3": {"node": "uv", "output": "outy"}}},
        {"id": "hue", "node": "hsvtorgb<vec3>", "inputs": {"in": {"node": "hsv"}}},
        {"id": "other", "node": "combine3", "inputs": {"in1": {"node": "uv", "output": "outy"}, "in2": {"node": "uv", "output": "outx"}, "in3": 0.5}},
        {"id": "hue4", "node": "combine4", "inputs": {"in1": {"node": "hue", "swizzle": "x"}, "in2": {"node": "hue", "swizzle": "y"}, "in3": {"node": "hue", "swizzle": "z"}, "in4": {"node": "uv", "output": "outx"}}},
        {"id": "other4", "node": "combine4", "inputs": {"in1": {"node": "other", "swizzle": "x"}, "in2": {"node": "other", "swizzle": "y"}, "in3": 0.5, "in4": {"node": "uv", "output": "outy"}}},
        {"id": "uv8", "node": "multiply<vec2, float>", "inputs": {"in1": {"given": "uv0"}, "in2": 8}},
        {"id": "p1", "node": "combine3", "inputs": {"in1": {"node": "uv", "output": "outx"}, "in2": {"node": "uv", "output": "outy"}, "in3": 0.3}},
        {"id": "p8", "node": "multiply<vec3, float>", "inputs": {"in1": {"node": "p1"}, "in2": 8}},
        {"id": "cells", "node": "cellnoise2d", "inputs": {"texcoord": {"node": "uv8"}}},
        {"id": "n", "node": node["name"], "inputs": inputs},
    ]
    if result in number:
        kind, port = number[result]
        nodes.append({"id": "shown", "node": kind, "inputs": {port: here}})
        here, result = {"node": "shown"}, "float"
    if result in ("mat3", "mat4"):
        row = "extract<mat3>" if result == "mat3" else "extract<mat4>"
        nodes.append({"id": "shown", "node": row, "inputs": {"in": here, "index": 0}})
        here, result = {"node": "shown"}, "vec3" if row.endswith("mat3>") else "vec4"
    if result not in WIDE:
        return None
    here = dict(here)
    here["swizzle"] = {1: "xxx", 2: "xyy", 3: "xyz", 4: "xyz"}[WIDE[result]]
    if WIDE[result] == 2:
        nodes.append({"id": "two", "node": "combine3", "inputs": {"in1": dict(here, swizzle="x"), "in2": dict(here, swizzle="y"), "in3": 0}})
        here = {"node": "two"}
    return {"lacquer_graph": 1, "name": "tile", "template": "forward", "attributes": [], "textures": textures, "nodes": nodes,
            "outputs": {"emission": here}}


def points():
    made = []
    for row in range(TILE):
        for column in range(TILE):
            u, v = (column + 0.5) / TILE, 1 - (row + 0.5) / TILE
            x, y = 2 * u - 1, 2 * v - 1
            inside = x * x + y * y
            n = [x, y, math.sqrt(1 - inside)] if inside < 0.98 else [x / math.sqrt(inside), y / math.sqrt(inside), 0.02]
            made.append({"uv0": [u, v], "uv1": [v, u], "uv2": [u, u], "uv3": [v, v], "position": [u, v, 0.3], "n": n, "v": [0, 0, 1], "l": [0, 0, 1],
                         "color0": [u, v, 1 - u, 1], "_SHOWN": [u, v, 0.5, 1]})
    return {"points": made, "uniforms": {"clock.time": 0.5, "clock.frame": 0.5}}


def run(command, **options):
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)


def tile(lacquer, folder, node):
    graph = graph_of(node)
    if graph is None:
        sys.exit(f"{node['name']} gives nothing that a tile shows")
    path = os.path.join(folder, "tile.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(graph, file)
    command = [lacquer, "eval", path, "--points", os.path.join(folder, "points.json")]
    for name in graph["textures"]:
        command += ["--texel", f"{name}=0.8,0.5,0.3,1"]
    done = run(command)
    if done.returncode != 0:
        sys.exit(f"{node['name']}: {done.stderr}")
    pixels = []
    for color in json.loads(done.stdout)["rgba"]:
        for x in color[:3]:
            x = min(max(x, 0), 1) if x == x else 0
            encoded = 12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055
            pixels.append(int(encoded * 255 + 0.5))
    return pixels


def png(width, rows):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    header = struct.pack(">IIBBBBB", width, len(rows), 8, 2, 0, 0, 0)
    body = zlib.compress(b"".join(b"\0" + bytes(row) for row in rows), 9)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", body) + chunk(b"IEND", b"")


def sheet(tiles):
    lines = (len(tiles) + COLUMNS - 1) // COLUMNS
    across = min(len(tiles), COLUMNS)
    width, height = across * (TILE + MARGIN) + MARGIN, lines * (TILE + MARGIN) + MARGIN
    rows = [[255] * (3 * width) for _ in range(height)]
    for index, pixels in enumerate(tiles):
        left = MARGIN + index % COLUMNS * (TILE + MARGIN)
        top = MARGIN + index // COLUMNS * (TILE + MARGIN)
        for y in range(TILE):
            rows[top + y][3 * left:3 * (left + TILE)] = pixels[3 * TILE * y:3 * TILE * (y + 1)]
    return png(width, rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lacquer")
    parser.add_argument("--check", action="store_true")
    arguments = parser.parse_args()
    lacquer = os.path.abspath(arguments.lacquer)
    listed = json.loads(run([lacquer, "nodes", "--json"]).stdout)["nodes"]
    families = {}
    for node in listed:
        if node.get("category") and node["file"].startswith("nodes/standard/"):
            families.setdefault((node["category"], node.get("family", node["name"])), []).append(node)
    made = {}
    text = ["# Pictures of the standard nodes", "",
            "What each of [the standard nodes](standard-nodes.md) gives over the plane, by the program's evaluator on the CPU: u runs to the",
            "right, v up, both from 0 to 1. Inputs without a better value take a ramp of hue, one of grey, or an image of one colour. Directions",
            "are those of a ball. The names stand in the order of the tiles, line by line.", "",
            "    ./dev bench pictures", ""]
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "points.json"), "w", encoding="utf-8") as file:
            json.dump(points(), file)
        for category in sorted({key[0] for key in families}):
            names = sorted(name for of, name in families if of == category)
            tiles = [tile(lacquer, folder, choose(families[category, name])) for name in names]
            made[f"standard-{category}.png"] = sheet(tiles)
            text += [f"## {category}", "", f"![{category}](images/standard-{category}.png)", ""]
            for first in range(0, len(names), COLUMNS):
                text.append(", ".join(f"`{name}`" for name in names[first:first + COLUMNS]) + ("" if first + COLUMNS >= len(names) else ","))
            text.append("")
    made_page = "\n".join(text).rstrip("\n") + "\n"
    files = {PAGE: made_page.encode()}
    files.update({os.path.join(FOLDER, name): data for name, data in made.items()})
    old = {path: open(path, "rb").read() if os.path.exists(path) else b"" for path in files}
    wrong = [os.path.relpath(path, ROOT) for path in files if old[path] != files[path]]
    if arguments.check:
        if wrong:
            sys.exit(f"not what the program makes: {', '.join(wrong)}")
        return
    os.makedirs(FOLDER, exist_ok=True)
    for path in files:
        with open(path, "wb") as file:
            file.write(files[path])


if __name__ == "__main__":
    main()
