"""How a coat's roughness changes what is seen: colours along an arc of the light, and a picture.

    python3 coat.py PICTURE.ppm
"""

import sys
from pathlib import Path

import numpy as np

import lacquer

root = Path(__file__).resolve().parents[2]
scene = lacquer.Scene.load(root / "examples/car_paint.gltf")
material = scene.find("Car paint")

# The shader, and the bytes of its uniform block for another roughness: no new shader is needed.
shader = scene.graph(material).generate({"targets": ["glsl"]})
print(shader.id, f"{len(shader.text('glsl'))} bytes of GLSL, {shader.uniform_size} of uniforms")
rough = shader.pack({"coat_roughness_factor": 0.8})
print(f"{sum(a != b for a, b in zip(rough, shader.pack()))} bytes differ")

# The reflected light while the lamp moves from the zenith to the horizon.
angles = np.radians(np.linspace(0, 85, 18))
points = [{"v": [0, 0.6, 0.8], "l": [0, -np.sin(a), np.cos(a)]} for a in angles]
colors = scene.evaluate(material, points, engine="float").rgba
for angle, color in zip(angles, colors):
    print(f"{np.degrees(angle):5.1f}  " + "  ".join(f"{x:.4f}" for x in color[:3]))

picture = scene.preview(material, 128)
Path(sys.argv[1]).write_bytes(b"P6\n128 128\n255\n" + picture.tobytes())
