#!/usr/bin/env python3
"""What MaterialX's pattern nodes cost here and in MaterialX's own GLSL, by the same driver compiler.

    bench/patterns.py build/release/lacquer MATERIALX [NODE...]

MATERIALX is a folder with MaterialX's WebAssembly module and a generate.mjs that runs its generators. Needs node.js,
glslangValidator, spirv-opt and Mesa's RADV. Prints the table of docs/patterns.md: instructions / inverse throughput on navi21.
"Written out" is with [[unroll]] before each loop, where what runs is what is counted: the driver counts a loop eightfold.
"""

import argparse
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

PLACE = {2: '"texcoord":{"given":"uv0"}', 3: '"position":{"given":"position"}'}
MAP = '{"texture":"map"}'

# our form, its result's type, its inputs; MaterialX's category, type and inputs
ROWS = [
    ("noise2d<float>", "float", PLACE[2], "noise2d", "float", ""),
    ("noise2d<vec3>", "vec3", PLACE[2], "noise2d", "vector3", ""),
    ("noise2d<vec4>", "vec4", PLACE[2], "noise2d", "vector4", ""),
    ("noise3d<float>", "float", PLACE[3], "noise3d", "float", ""),
    ("noise3d<vec3>", "vec3", PLACE[3], "noise3d", "vector3", ""),
    ("fractal2d<float>", "float", PLACE[2], "fractal2d", "float", ""),
    ("fractal2d<vec3>", "vec3", PLACE[2], "fractal2d", "vector3", ""),
    ("fractal3d<float>", "float", PLACE[3], "fractal3d", "float", ""),
    ("fractal3d<vec4>", "vec4", PLACE[3], "fractal3d", "vector4", ""),
    ("cellnoise2d", "float", PLACE[2], "cellnoise2d", "float", ""),
    ("cellnoise3d", "float", PLACE[3], "cellnoise3d", "float", ""),
    ("worleynoise2d<float>", "float", PLACE[2], "worleynoise2d", "float", ""),
    ("worleynoise2d<vec3>", "vec3", PLACE[2], "worleynoise2d", "vector3", ""),
    ("worleynoise3d<float>", "float", PLACE[3], "worleynoise3d", "float", ""),
    ("worleynoise3d<vec3>", "vec3", PLACE[3], "worleynoise3d", "vector3", ""),
    ("unifiednoise2d", "float", PLACE[2] + ',"type":3', "unifiednoise2d", "float", "<input name='type' type='integer' value='3'/>"),
    ("unifiednoise3d", "float", PLACE[3] + ',"type":2', "unifiednoise3d", "float", "<input name='type' type='integer' value='2'/>"),
    ("flake3d", "rand", PLACE[3], "flake3d", "rand", ""),
    ("hextiledimage<vec3>", "vec3", f'"file":{MAP},{PLACE[2]}', "hextiledimage", "color3", ""),
    ("triplanarprojection<vec4>", "vec4", f'"filex":{MAP},"filey":{MAP},"filez":{MAP},{PLACE[3]},"normal":{{"given":"normal"}},"blend":0.5',
     "triplanarprojection", "color4", "<input name='blend' type='float' value='0.5'/>"),
    ("triplanarprojection<vec3>", "vec3", f'"filex":{MAP},"filey":{MAP},"filez":{MAP},{PLACE[3]},"normal":{{"given":"normal"}}',
     "triplanarprojection", "color3", ""),
]
# ours alone, which have a variant that is filtered
TILINGS = [("checkerboard", "vec3", PLACE[2]), ("grid", "vec3", PLACE[2])]
SOURCES = {
    "float": '"factor":1,"strength":{"node":"n"}',
    "rand": '"factor":1,"strength":{"node":"n","output":"rand"}',
    "vec3": '"factor":{"node":"n"}',
    "vec4": '"factor":{"node":"n","swizzle":"xyz"},"strength":{"node":"n","swizzle":"w"}',
}


def run(*command, **options):
    done = subprocess.run(command, capture_output=True, text=True, check=False, **options)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{done.stdout}{done.stderr}")
    return done.stdout


def compiled(lacquer, base, text, unroll):
    """The cost of a fragment shader's GLSL by glslang and spirv-opt, linked with the vertex shader beside it."""
    passes = []
    if unroll:
        text = text.replace("#version 450", "#version 450\n#extension GL_EXT_control_flow_attributes : enable", 1)
        text = re.sub(r"\bfor \(", "[[unroll]] for (", text)
        passes = ["--inline-entry-points-exhaustive", "--eliminate-dead-functions", "--scalar-replacement=100", "--ssa-rewrite",
                  "--ccp", "--loop-unroll"]
    with open(base + ".frag", "w", encoding="utf-8") as file:
        file.write(text)
    for stage in ("frag", "vert"):
        run("glslangValidator", "-V", "--target-env", "vulkan1.1", f"{base}.{stage}", "-o", f"{base}.{stage}.raw")
    run("spirv-opt", "--merge-return", *passes, "-O", f"{base}.frag.raw", "-o", f"{base}.frag.spv")
    os.replace(f"{base}.vert.raw", f"{base}.vert.spv")
    return cost(lacquer, f"{base}.frag.spv")


def ours(lacquer, folder, row, variant=""):
    """The cost as it is, and with its loops written out."""
    form, result, inputs = row[:3]
    choice = f'"variant":"{variant}",' if variant else ""
    graph = os.path.join(folder, "g.json")
    with open(graph, "w", encoding="utf-8") as file:
        file.write(
            '{"lacquer_graph":1,"name":"g","template":"forward","attributes":["TEXCOORD_0","NORMAL"],'
            '"textures":{"map":{"type":"sampler2D","srgb":false}},'
            f'"nodes":[{{"id":"n","node":"{form}",{choice}"inputs":{{{inputs}}}}},'
            f'{{"id":"e","node":"emission","inputs":{{{SOURCES[result]}}}}}],"outputs":{{"emission":{{"node":"e"}}}}}}'
        )
    out = os.path.join(folder, "out")
    run("rm", "-rf", out)
    run(lacquer, "gen", "--graph", graph, "-o", out, "--lights", "none")
    plain = cost(lacquer, out)
    glsl = glob.glob(os.path.join(out, "glsl", "*.frag.glsl"))[0]
    text = open(glsl, encoding="utf-8").read()
    if "for (" not in text:
        return plain, plain
    base = os.path.join(folder, "unrolled")
    shutil.copy(glsl.replace(".frag.", ".vert."), base + ".vert")
    return plain, compiled(lacquer, base, text, True)


def theirs(lacquer, materialx, folder, row):
    """The same of MaterialX's."""
    _, _, _, category, kind, inputs = row
    if kind == "rand":
        nodes = f"<{category} name='f' type='multioutput'>{inputs}</{category}><add name='n' type='float'>" \
                "<input name='in1' type='float' nodename='f' output='rand'/></add>"
        kind = "float"
    else:
        nodes = f"<{category} name='n' type='{kind}'>{inputs}</{category}>"
    with open(os.path.join(folder, "a.mtlx"), "w", encoding="utf-8") as file:
        file.write(f"<?xml version='1.0'?><materialx version='1.39'><nodegraph name='g'>{nodes}"
                   f"<output name='out' type='{kind}' nodename='n'/></nodegraph></materialx>")
    run("node", os.path.join(os.path.abspath(materialx), "generate.mjs"), "a.mtlx", "peer", "VkShaderGenerator", "best", cwd=folder)
    base = os.path.join(folder, "peer", "g_out")
    text = open(base + ".pixel", encoding="utf-8").read()
    os.replace(base + ".vertex", base + ".vert")
    return compiled(lacquer, base, text, False), compiled(lacquer, base, text, True)


def cost(lacquer, what):
    lines = run(lacquer, "cost", what).splitlines()
    numbers = [int(x) for x in re.findall(r"\d+", lines[-1].split("|")[1])]
    return numbers[0], numbers[4]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lacquer")
    parser.add_argument("materialx")
    parser.add_argument("rows", nargs="*", help="forms such as noise2d<float>; all when absent")
    arguments = parser.parse_args()
    lacquer = os.path.abspath(arguments.lacquer)
    only = set(arguments.rows)
    rows = [row for row in ROWS if not only or row[0] in only]
    filtered_rows = [row for row in rows if row[0].startswith(("noise", "fractal")) and row[1] == "float"]
    filtered_rows += [row for row in TILINGS if not only or row[0] in only]
    print("| node | here | MaterialX | here, of it | written out: here | MaterialX | here, of it |")
    print("|---|---|---|---|---|---|---|")
    ratios = ([], [])
    with tempfile.TemporaryDirectory() as folder:
        for row in rows:
            cells = [f"`{row[0]}`"]
            for mine, peer, all_ratios in zip(ours(lacquer, folder, row), theirs(lacquer, arguments.materialx, folder, row), ratios):
                all_ratios.append(mine[1] / peer[1])
                cells += [f"{mine[0]} / {mine[1]}", f"{peer[0]} / {peer[1]}", f"{100 * all_ratios[-1]:.0f} %"]
            print("| " + " | ".join(cells) + " |", flush=True)
        if rows:
            means = [100 * sum(r) / len(r) for r in ratios]
            print(f"| mean | | | {means[0]:.0f} % | | | {means[1]:.0f} % |")
        print("\n| node | plain | `filtered` |\n|---|---|---|")
        for row in filtered_rows:
            plain, filtered = ours(lacquer, folder, row)[0], ours(lacquer, folder, row, "filtered")[0]
            print(f"| `{row[0]}` | {plain[0]} / {plain[1]} | {filtered[0]} / {filtered[1]} |", flush=True)


if __name__ == "__main__":
    main()
