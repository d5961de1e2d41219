#!/usr/bin/env python3
"""How long a farm takes over many materials: a simulation over action times that are measured here.

usage: farm.py LACQUER FILE... [--materials N] [--structures N] [--workers N,N...] [--hits PART]
               [--latency SECONDS] [--bandwidth BYTES] [--measure N] [--json]

Plans the files, runs some of the actions as they are declared, one after the other, and takes the time and the bytes of
each. Then it draws as many actions as there are structures among these, gives them to workers in the plan's order, and
adds what a store of results costs: an answer for each action, the inputs that a worker has not yet, the outputs. Reading
and merging grow with the materials, and are measured on two sizes of a file made of the first one's materials.
"""
import argparse
import heapq
import json
import os
import random
import resource
import subprocess
import sys
import tempfile


def run(command, folder):
    """Seconds of processor time that a command takes: what else the machine does is not in it."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, cwd=folder, env={}, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}: {done.stdout.decode(errors='replace')}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def plan(lacquer, files, folder):
    seconds = run([lacquer, "plan", *files, "--ninja", "build.ninja", "--json", "actions.json", "-o", "out", "-q",
                   "--unused", "--no-sync"], folder)
    with open(os.path.join(folder, "actions.json"), encoding="utf-8") as file:
        return json.load(file)["actions"], seconds


def size(folder, paths):
    return sum(os.path.getsize(os.path.join(folder, path)) for path in paths)


def measure_actions(actions, lacquer, folder, most):
    """Seconds, bytes in (without the program) and bytes out of some shaders' actions, spread evenly."""
    shaders = actions[:-1]
    step = max(1, len(shaders) // most)
    samples = []
    for action in shaders[::step][:most]:
        seconds = run(action["command"], folder)
        inputs = [path for path in action["inputs"] if path != lacquer]
        samples.append({"seconds": seconds, "in": size(folder, inputs), "out": size(folder, action["outputs"])})
    return samples


def repeated(path, count):
    """A file of `count` materials: those of the first file, again and again, with other names and numbers."""
    with open(path, encoding="utf-8") as file:
        gltf = json.load(file)
    materials = gltf.get("materials", [{}])
    many = []
    for i in range(count):
        material = json.loads(json.dumps(materials[i % len(materials)]))
        material["name"] = f"material {i}"
        material.setdefault("pbrMetallicRoughness", {})["roughnessFactor"] = 0.1 + 0.8 * (i * 0.618 % 1)
        many.append(material)
    kept = {key: gltf[key] for key in ("asset", "extensionsUsed", "images", "textures", "samplers") if key in gltf}
    return {**kept, "materials": many}


def measure_materials(lacquer, path, sizes=(2000, 20000), rounds=2):
    """Seconds of planning and of merging for one more material, the least of some rounds each, and the manifest's bytes for it."""
    rows = []
    for count in sizes:
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "many.gltf"), "w", encoding="utf-8") as file:
                json.dump(repeated(path, count), file)
            plans = [plan(lacquer, ["many.gltf"], folder) for _ in range(rounds)]
            actions = plans[0][0]
            for action in actions[:-1]:
                run(action["command"], folder)
            merged = min(run(actions[-1]["command"], folder) for _ in range(rounds))
            rows.append((count, min(seconds for _, seconds in plans), merged, size(folder, actions[-1]["outputs"])))
    (a, plan_a, merge_a, bytes_a), (b, plan_b, merge_b, bytes_b) = rows
    more = b - a
    return {"plan": max(0.0, plan_b - plan_a) / more, "merge": max(0.0, merge_b - merge_a) / more,
            "bytes": (bytes_b - bytes_a) / more}


def simulate(durations, workers):
    """Seconds until the last of the actions ends, each given to the worker that is free first."""
    free = [0.0] * min(workers, max(1, len(durations)))
    heapq.heapify(free)
    for seconds in durations:
        heapq.heappush(free, heapq.heappop(free) + seconds)
    return max(free)


def farm(samples, each, program, arguments, workers):
    """One row: what `workers` machines take for all."""
    draw = random.Random(1)
    durations, moved, made = [], 0, 0
    for _ in range(arguments.structures):
        sample = draw.choice(samples)
        seconds, store = arguments.latency, sample["in"]
        if draw.random() < arguments.hits:
            moved += sample["out"]
            seconds += sample["out"] / arguments.bandwidth
        else:
            made += 1
            moved += store + sample["out"]
            seconds += sample["seconds"] + (store + sample["out"]) / arguments.bandwidth
        durations.append(seconds)
    used = min(workers, made)
    moved += used * program  # each worker fetches the program once
    actions = simulate(durations, workers) + (program / arguments.bandwidth if made else 0)
    reading = each["plan"] * arguments.materials
    merging = each["merge"] * arguments.materials
    return {"workers": workers, "actions": arguments.structures + 1, "made": made, "bytes": moved,
            "plan_seconds": reading, "action_seconds": actions, "merge_seconds": merging,
            "seconds": reading + actions + merging, "manifest_bytes": each["bytes"] * arguments.materials}


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("lacquer")
    parser.add_argument("files", nargs="+")
    parser.add_argument("--materials", type=int, default=1_000_000)
    parser.add_argument("--structures", type=int, default=4000)
    parser.add_argument("--workers", default="1,10,100,1000")
    parser.add_argument("--hits", type=float, default=0.0, help="the part of the actions that the store has")
    parser.add_argument("--latency", type=float, default=0.02, help="of the store, for each action")
    parser.add_argument("--bandwidth", type=float, default=100e6, help="bytes in a second, of each worker")
    parser.add_argument("--measure", type=int, default=24, help="actions that are run for their times")
    parser.add_argument("--json", action="store_true")
    return parser.parse_args()


def main():
    arguments = parse()
    lacquer = os.path.abspath(arguments.lacquer)
    files = [os.path.abspath(path) for path in arguments.files]
    with tempfile.TemporaryDirectory() as folder:
        actions, _ = plan(lacquer, files, folder)
        samples = measure_actions(actions, lacquer, folder, arguments.measure)
    each = measure_materials(lacquer, files[0])
    rows = [farm(samples, each, os.path.getsize(lacquer), arguments, int(count)) for count in arguments.workers.split(",")]
    mean = sum(sample["seconds"] for sample in samples) / len(samples)
    if arguments.json:
        print(json.dumps({"measured": len(samples), "mean_seconds": mean, "for_each_material": each, "rows": rows}, indent=2))
        return
    print(f"{len(samples)} actions measured: {mean:.3f} s in the mean, {max(s['seconds'] for s in samples):.3f} s at most; "
          f"{sum(s['in'] for s in samples) / len(samples) / 1e3:.0f} kB in, {sum(s['out'] for s in samples) / len(samples) / 1e3:.0f} kB out")
    print(f"for each material: {each['plan'] * 1e6:.0f} us of planning, {each['merge'] * 1e6:.0f} us of merging, {each['bytes']:.0f} bytes\n")
    print("| workers | actions | made | moved | planning | shaders | merging | together |\n|---|---|---|---|---|---|---|---|")
    for row in rows:
        print(f"| {row['workers']} | {row['actions']} | {row['made']} | {row['bytes'] / 1e9:.2f} GB | {row['plan_seconds']:.0f} s | "
              f"{row['action_seconds']:.1f} s | {row['merge_seconds']:.0f} s | {row['seconds']:.0f} s |")


if __name__ == "__main__":
    main()
