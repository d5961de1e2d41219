"""Evaluation of points in arrays, by the Python package: microseconds of a core for each, of the work W1.

    LACQUER_LIBRARY=build/release/liblacquer.so PYTHONPATH=python python3 bench/points.py
"""
import time
from pathlib import Path

import numpy as np

import lacquer

COUNT = 1_000_000
ROUNDS = 5


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def main():
    scene = lacquer.Scene.load(Path(__file__).parent / "works" / "w1.gltf")
    random = np.random.default_rng(1)
    normal = unit(random.normal(size=(COUNT, 3)))
    points = {"n": normal} | {name: unit(normal + random.normal(size=(COUNT, 3)) / 2) for name in ("v", "l")}
    for engine in ("double", "float"):
        times = []
        for _ in range(ROUNDS):
            start = time.process_time()
            scene.evaluate(0, points, engine=engine)
            times.append((time.process_time() - start) / COUNT * 1e6)
        print(f"{engine}: {min(times):.2f} (the most {max(times):.2f})")


if __name__ == "__main__":
    main()
