#!/usr/bin/env python3
"""Files with as many materials of as many structures as you like, always the same ones.

usage: studio.py FOLDER [--materials N] [--structures N] [--files N]

Writes FOLDER/studio_0.gltf and so on. Material number i has structure i modulo N, and numbers of its own. No two structures
are alike: which layers and textures there are, which UV set and transform each texture has, the alpha mode and the sides are
drawn from a generator with a fixed seed, again where they were drawn before.
"""
import argparse
import json
import os
import random

TEXTURED = {
    "KHR_materials_clearcoat": ("clearcoatFactor", ["clearcoatTexture", "clearcoatRoughnessTexture"]),
    "KHR_materials_coat": ("coatFactor", ["coatTexture", "coatColorTexture", "coatRoughnessTexture"]),
    "KHR_materials_sheen": (None, ["sheenColorTexture"]),
    "KHR_materials_transmission": ("transmissionFactor", ["transmissionTexture"]),
    "KHR_materials_iridescence": ("iridescenceFactor", ["iridescenceTexture"]),
    "KHR_materials_anisotropy": ("anisotropyStrength", ["anisotropyTexture"]),
    "KHR_materials_specular": ("specularFactor", ["specularTexture"]),
}
CORE = ["baseColorTexture", "metallicRoughnessTexture"]
SURFACE = ["normalTexture", "occlusionTexture", "emissiveTexture"]
EXTENSIONS = sorted([*TEXTURED, "KHR_materials_ior", "KHR_texture_transform"])


def texture(draw):
    """None, or the part of a texture that belongs to the structure."""
    if draw.random() < 0.55:
        return None
    info = {"index": draw.randrange(3)}
    if draw.random() < 0.25:
        info["texCoord"] = 1
    if draw.random() < 0.2:
        info["extensions"] = {"KHR_texture_transform": {"scale": [2, 2]}}
    return info


def structure(draw):
    """A material without its numbers."""
    material = {"pbrMetallicRoughness": {name: info for name in CORE if (info := texture(draw))}}
    for name in SURFACE:
        if info := texture(draw):
            material[name] = info
    if "emissiveTexture" in material:
        material["emissiveFactor"] = [1, 1, 1]
    if draw.random() < 0.15:
        material["alphaMode"] = "MASK"
    if draw.random() < 0.25:
        material["doubleSided"] = True
    extensions = {}
    layers = [name for name in sorted(TEXTURED) if name != "KHR_materials_clearcoat"]
    for name in draw.sample(layers, draw.choice([0, 0, 1, 1, 2])):
        extensions[name] = {slot: info for slot in TEXTURED[name][1] if (info := texture(draw))}
    if "KHR_materials_coat" not in extensions and draw.random() < 0.3:
        extensions["KHR_materials_clearcoat"] = {}
    if draw.random() < 0.2:
        extensions["KHR_materials_ior"] = {}
    if extensions:
        material["extensions"] = extensions
    return material


def structures(count):
    draw, known, found = random.Random(1), set(), []
    while len(found) < count:
        one = structure(draw)
        text = json.dumps(one, sort_keys=True)
        if text not in known:
            known.add(text)
            found.append(one)
    return found


def number(i, salt):
    """In [0.1, 0.9), another for each material."""
    return round(0.1 + 0.8 * ((i + 1) * (salt + 1) * 0.6180339887 % 1), 6)


def material(i, kinds):
    one = json.loads(json.dumps(kinds[i % len(kinds)]))
    one["name"] = f"material {i}"
    core = one["pbrMetallicRoughness"]
    core["baseColorFactor"] = [number(i, 0), number(i, 1), number(i, 2), 1]
    core["metallicFactor"], core["roughnessFactor"] = number(i, 3), number(i, 4)
    for name, extension in one.get("extensions", {}).items():
        if name == "KHR_materials_ior":
            extension["ior"] = 1.1 + number(i, 5) / 2
        elif TEXTURED[name][0]:
            extension[TEXTURED[name][0]] = number(i, 6)
        if name == "KHR_materials_sheen":
            extension["sheenColorFactor"] = [number(i, 7)] * 3
        if name == "KHR_materials_specular":
            extension["specularColorFactor"] = [number(i, 8)] * 3
    return one


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder")
    parser.add_argument("--materials", type=int, default=10_000)
    parser.add_argument("--structures", type=int, default=400)
    parser.add_argument("--files", type=int, default=20)
    arguments = parser.parse_args()
    kinds = structures(arguments.structures)
    os.makedirs(arguments.folder, exist_ok=True)
    for file in range(arguments.files):
        gltf = {"asset": {"version": "2.0"}, "extensionsUsed": EXTENSIONS, "images": [{"uri": "a.png"}],
                "textures": [{"source": 0}] * 3,
                "materials": [material(i, kinds) for i in range(file, arguments.materials, arguments.files)]}
        with open(os.path.join(arguments.folder, f"studio_{file}.gltf"), "w", encoding="utf-8") as out:
            json.dump(gltf, out)


if __name__ == "__main__":
    main()
