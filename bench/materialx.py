#!/usr/bin/env python3
"""What MaterialX's materials cost here and in MaterialX's own shaders, by the same driver compiler.

    bench/materialx.py build/release/lacquer MATERIALX FILE.mtlx... [--times] [--json FILE]

MATERIALX is a folder with MaterialX's WebAssembly module and a generate.mjs that runs its generators. Needs node.js,
glslangValidator, spirv-opt and Mesa's RADV. Prints a table: inverse throughput of the fragment stage on navi21, one
directional light and a prefiltered environment, and the bytes of both stages' SPIR-V. MaterialX's GLSL goes through glslang
and `spirv-opt -O`. "Viewers" is its shader with all inputs editable, "baked" the one whose numbers are constants. Here "editable" has every number in a uniform block, "literal" none.
With --times also milliseconds: of its way glslang and spirv-opt alone, of ours the whole process from the document to SPIR-V.
"""

import argparse
import glob
import json
import os
import re
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree

COLUMNS = ("viewers", "baked", "editable", "literal")


def run(*command, **options):
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)


def cost(lacquer, what):
    """Inverse throughput of the fragment stage."""
    done = run(lacquer, "cost", what, "--json")
    if done.returncode != 0:
        raise RuntimeError(done.stderr)
    shaders = json.loads(done.stdout)["shaders"]
    return max(shader["gpus"]["navi21"]["inverse_throughput"] for shader in shaders)


def ours(lacquer, document, name, folder, literal):
    out = os.path.join(folder, "literal" if literal else "editable")
    flags = ["--params", "baked"] if literal else []
    begin = time.perf_counter()
    done = run(lacquer, "gen", document, "--material", name, "-o", out, "--lights", "directional:1", "--target", "spirv",
               "--no-validate", "-q", *flags)
    spent = time.perf_counter() - begin
    if done.returncode != 0:
        raise RuntimeError(done.stderr)
    files = glob.glob(os.path.join(out, "spirv", "*.spv"))
    return {"cost": cost(lacquer, out), "bytes": sum(os.path.getsize(file) for file in files), "ms": 1000 * spent}


def generated(materialx, document, out, generator, how):
    run("node", os.path.join(os.path.abspath(materialx), "generate.mjs"), os.path.abspath(document), out, generator, how,
        cwd=os.path.dirname(os.path.abspath(document)))
    return sorted(glob.glob(os.path.join(out, "*.pixel")))


def baked(text, with_values):
    """The block of the material's numbers as constants, whose values the generator for OpenGL writes beside its uniforms."""
    values = dict(re.findall(r"^uniform \w+ (\w+) = (.*);$", with_values, re.M))

    def constants(block):
        members = re.findall(r"^\s*(\w+) (\w+);$", block[1], re.M)
        return "\n".join(f"const {kind} {name} = {values[name]};" for kind, name in members)

    return re.sub(r"layout \(std140, binding=\d+\) uniform PublicUniforms_pixel\n\{\n(.*?)\n\};", constants, text, flags=re.S)


def theirs(lacquer, materialx, document, folder, how):
    """By material, with the time of glslang and spirv-opt."""
    made = {}
    literal = how == "baked"
    out = os.path.join(folder, how)
    plain = {os.path.basename(pixel): pixel
             for pixel in (generated(materialx, document, out + "_gl", "GlslShaderGenerator", "best") if literal else ())}
    for pixel in generated(materialx, document, out, "VkShaderGenerator", "best" if literal else "prefilter"):
        base = pixel.removesuffix(".pixel")
        with open(pixel, encoding="utf-8") as file:
            text = file.read()
        if literal:
            if os.path.basename(pixel) not in plain:
                continue
            with open(plain[os.path.basename(pixel)], encoding="utf-8") as file:
                text = baked(text, file.read())
        with open(base + ".frag", "w", encoding="utf-8") as file:
            file.write(text)
        os.replace(base + ".vertex", base + ".vert")
        begin = time.perf_counter()
        steps = []
        for stage in ("frag", "vert"):
            steps.append(run("glslangValidator", "-V", "--target-env", "vulkan1.1", f"{base}.{stage}", "-o", f"{base}.{stage}.raw"))
            steps.append(run("spirv-opt", "-O", f"{base}.{stage}.raw", "-o", f"{base}.{stage}.spv"))
        if any(step.returncode for step in steps):
            continue
        spent = time.perf_counter() - begin
        size = sum(os.path.getsize(f"{base}.{stage}.spv") for stage in ("frag", "vert"))
        made[os.path.basename(base)] = {"cost": cost(lacquer, base + ".frag.spv"), "bytes": size, "ms": 1000 * spent}
    return made


def materials(document):
    """Each material's name with that of its surface, by which the peer calls it."""
    for material in xml.etree.ElementTree.parse(document).getroot().iter("surfacematerial"):
        for given in material.findall("input[@name='surfaceshader']"):
            yield material.get("name"), given.get("nodename")


def measured(lacquer, materialx, document):
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        peer = {how: theirs(lacquer, materialx, document, folder, how) for how in ("viewers", "baked")}
        for name, surface in materials(document):
            row = {"file": os.path.basename(document), "material": name}
            for how in ("viewers", "baked"):
                row[how] = peer[how].get(surface)
            try:
                row["editable"] = ours(lacquer, document, name, folder, False)
                row["literal"] = ours(lacquer, document, name, folder, True)
            except RuntimeError as error:
                print(f"{document}: {name}: {error}", file=sys.stderr)
                continue
            if all(row[how] for how in COLUMNS):
                rows.append(row)
            else:
                print(f"{document}: {name}: MaterialX has no shader of it", file=sys.stderr)
    return rows


def percent(rows, what, ours_is, of):
    ratios = [100 * row[ours_is][what] / row[of][what] for row in rows]
    return f"{sum(ratios) / len(ratios):.0f} % ({min(ratios):.0f} to {max(ratios):.0f})"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lacquer")
    parser.add_argument("materialx")
    parser.add_argument("documents", nargs="+")
    parser.add_argument("--times", action="store_true")
    parser.add_argument("--json", help="the numbers as JSON")
    arguments = parser.parse_args()
    lacquer = os.path.abspath(arguments.lacquer)
    print("| material | MaterialX in viewers | baked | here, editable | literal | editable, of baked |")
    print("|---|---|---|---|---|---|")
    rows = []
    for document in arguments.documents:
        for row in measured(lacquer, arguments.materialx, document):
            rows.append(row)
            cells = [str(row[how]["cost"]) for how in COLUMNS]
            print(f"| `{row['material']}` | {' | '.join(cells)} | {100 * row['editable']['cost'] / row['baked']['cost']:.0f} % |", flush=True)
    if not rows:
        sys.exit("no material that both draw")
    for ours_is, of in (("editable", "viewers"), ("editable", "baked"), ("literal", "baked")):
        print(f"\n{ours_is} of {of}: cost {percent(rows, 'cost', ours_is, of)}, bytes {percent(rows, 'bytes', ours_is, of)}", end="")
        print(f", time {percent(rows, 'ms', ours_is, of)}" if arguments.times else "")
    if arguments.json:
        with open(arguments.json, "w", encoding="utf-8") as file:
            json.dump(rows, file, indent=1)
            file.write("\n")


if __name__ == "__main__":
    main()
