#!/usr/bin/env python3
"""What MaterialX's materials cost here and in MaterialX's own shaders, by the same driver compiler.

    bench/materialx.py build/release/lacquer MATERIALX PATH... [--markdown FILE] [--json FILE]

MATERIALX is a folder with MaterialX's WebAssembly module and a generate.mjs that runs its generators; a PATH is a document, or
a folder whose documents are taken with those below it. Needs node.js, glslangValidator, spirv-opt and Mesa's RADV. Prints a
table, a row for each material: inverse throughput of the fragment stage on navi21, one directional light and a prefiltered
environment; the bytes of both stages' SPIR-V; milliseconds of processor time.

MaterialX's GLSL goes through glslang and `spirv-opt -O`. "sampled" is its default, 16 samples of the environment; "viewers" the
same with a prefiltered one; both have all inputs editable. "baked" has their numbers as constants and its generator's options
for least code. Here "editable" (--as materialx) has every number in a uniform block, "literal" none, and "gltf" (--as gltf) is
editable, too. Time is that of glslang and spirv-opt alone of its way, and of the whole process from the document to SPIR-V of ours.
--markdown writes the table and the sums into a block of FILE between `<!-- measured: materialx -->` and `<!-- :measured -->`.
"""

import argparse
import glob
import json
import os
import re
import resource
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

PEERS = ("sampled", "viewers", "baked")
OURS = {"editable": ["--as", "materialx"], "literal": ["--as", "materialx", "--params", "baked"], "gltf": ["--as", "gltf"]}
COLUMNS = (*PEERS, *OURS)
# What is asked of each ratio of two columns: of the mean, and of each.
GOALS = (("cost", "editable", "baked", 0.9, 1), ("cost", "literal", "baked", 0.8, None), ("cost", "editable", "viewers", 1 / 6, None),
         ("cost", "editable", "sampled", 1 / 6, None), ("bytes", "editable", "viewers", 0.1, None), ("ms", "editable", "viewers", 0.01, None),
         ("cost", "gltf", "editable", None, None))


def run(*command, **options):
    return subprocess.run(command, capture_output=True, text=True, check=False, **options)


def timed(*command):
    """A process, and the seconds of processor time that it took."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = run(*command)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return done, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def cost(lacquer, what):
    """Inverse throughput of the fragment stage."""
    done = run(lacquer, "cost", what, "--json")
    if done.returncode != 0:
        raise RuntimeError(done.stderr)
    shaders = json.loads(done.stdout)["shaders"]
    return max(shader["gpus"]["navi21"]["inverse_throughput"] for shader in shaders)


def ours(lacquer, document, name, folder, how):
    out = os.path.join(folder, "ours_" + how)
    done, spent = timed(lacquer, "gen", document, "--material", name, "-o", out, "--lights", "directional:1", "--target", "spirv",
                        "--no-validate", "-q", "--jobs", "1", *OURS[how])
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
    """By surface, with the time of glslang and spirv-opt."""
    made = {}
    literal = how == "baked"
    out = os.path.join(folder, how)
    options = {"sampled": "default", "viewers": "prefilter", "baked": "best"}[how]
    plain = {os.path.basename(pixel): pixel
             for pixel in (generated(materialx, document, out + "_gl", "GlslShaderGenerator", options) if literal else ())}
    for pixel in generated(materialx, document, out, "VkShaderGenerator", options):
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
        steps = []
        for stage in ("frag", "vert"):
            steps.append(timed("glslangValidator", "-V", "--target-env", "vulkan1.1", f"{base}.{stage}", "-o", f"{base}.{stage}.raw"))
            steps.append(timed("spirv-opt", "-O", f"{base}.{stage}.raw", "-o", f"{base}.{stage}.spv"))
        if any(step.returncode for step, spent in steps):
            continue
        size = sum(os.path.getsize(f"{base}.{stage}.spv") for stage in ("frag", "vert"))
        made[os.path.basename(base)] = {"cost": cost(lacquer, base + ".frag.spv"), "bytes": size,
                                        "ms": 1000 * sum(spent for step, spent in steps)}
    return made


def materials(document):
    """Each material's name with that of its surface, by which the peer calls it."""
    for material in xml.etree.ElementTree.parse(document).getroot().iter("surfacematerial"):
        for given in material.findall("input[@name='surfaceshader']"):
            yield material.get("name"), given.get("nodename")


def measured(lacquer, materialx, document):
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        peer = {how: theirs(lacquer, materialx, document, folder, how) for how in PEERS}
        found = list(materials(document))
        for name, surface in found:
            row = {"file": os.path.basename(document), "material": name, "alone": len(found) == 1}
            for how in PEERS:
                row[how] = peer[how].get(surface) or peer[how].get(name)
            try:
                for how in OURS:
                    row[how] = ours(lacquer, document, name, folder, how)
            except RuntimeError as error:
                print(f"{document}: {name}: {error}", file=sys.stderr)
                continue
            if all(row[how] for how in COLUMNS):
                rows.append(row)
            else:
                print(f"{document}: {name}: MaterialX has no shader of it", file=sys.stderr)
    return rows


def label(row):
    """The document's name, and the material's where it has several."""
    name = row["file"].removesuffix(".mtlx")
    return name if row["alone"] else f"{name}: {row['material']}"


def shown(row):
    costs = " | ".join(str(row[how]["cost"]) for how in COLUMNS)
    part = 100 * row["editable"]["cost"] / row["baked"]["cost"]
    kilobytes = " | ".join(f"{row[how]['bytes'] / 1000:.1f}" for how in ("viewers", "editable"))
    times = " | ".join(f"{row[how]['ms']:.0f}" for how in ("viewers", "editable"))
    return f"| `{label(row)}` | {costs} | {part:.0f} % | {kilobytes} | {times} |"


def sums(rows):
    yield "| what | of | mean | least, most | asked of the mean | who is beyond |"
    yield "|---|---|---|---|---|---|"
    names = {"cost": "cost", "bytes": "bytes", "ms": "time"}
    for what, mine, of, mean, each in GOALS:
        values = [row[mine][what] / row[of][what] for row in rows]
        bound = each or mean
        beyond = [f"`{label(row)}`" for row, ratio in zip(rows, values) if bound and ratio > bound]
        asked = "" if mean is None else f"{100 * mean:.0f} %" + (f", each {100 * each:.0f} %" if each else "")
        who = "none" if bound and not beyond else ", ".join(beyond) if len(beyond) <= 6 else f"{len(beyond)} of {len(rows)}"
        digits = 2 if what == "ms" else 0
        yield (f"| {names[what]}, {mine} | {of} | {100 * sum(values) / len(values):.{digits}f} % | "
               f"{100 * min(values):.{digits}f} % to {100 * max(values):.{digits}f} % | {asked} | {who} |")


def documents_of(paths):
    for path in paths:
        if os.path.isdir(path):
            yield from sorted(glob.glob(os.path.join(path, "**", "*.mtlx"), recursive=True))
        else:
            yield path


def write_block(path, lines):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    begin, end = "<!-- measured: materialx -->\n", "<!-- :measured -->"
    head, rest = text.split(begin)
    tail = rest.split(end, 1)[1]
    with open(path, "w", encoding="utf-8") as file:
        file.write(head + begin + "\n".join(lines) + "\n" + end + tail)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lacquer")
    parser.add_argument("materialx")
    parser.add_argument("paths", nargs="+")
    parser.add_argument("--markdown", help="the file that has the table")
    parser.add_argument("--json", help="the numbers as JSON")
    arguments = parser.parse_args()
    lacquer = os.path.abspath(arguments.lacquer)
    lines = ["| material | sampled | viewers | baked | editable | literal | gltf | editable, of baked | kB, viewers | editable | ms, viewers | editable |",
             "|" + "---|" * 12]
    print("\n".join(lines), flush=True)
    rows = []
    for document in documents_of(arguments.paths):
        for row in measured(lacquer, arguments.materialx, document):
            rows.append(row)
            lines.append(shown(row))
            print(lines[-1], flush=True)
    if not rows:
        sys.exit("no material that both draw")
    summed = list(sums(rows))
    print("\n" + "\n".join(summed))
    if arguments.markdown:
        write_block(arguments.markdown, [*lines, "", *summed])
    if arguments.json:
        with open(arguments.json, "w", encoding="utf-8") as file:
            json.dump(rows, file, indent=1)
            file.write("\n")


if __name__ == "__main__":
    main()
