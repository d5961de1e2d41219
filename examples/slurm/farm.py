#!/usr/bin/env python3
"""Hands the actions of a plan (`lacquer plan --json`) to Slurm as array jobs.

usage: farm.py submit ACTIONS [--tasks N] [--scratch FOLDER] [-- SBATCH_OPTION...]
       farm.py run ACTIONS STAGE TASK TASKS [--scratch FOLDER]

`submit` is called in the folder that the plan's paths begin in, which all workers must see. What reads another action's
output comes a stage later; a stage is one array job of at most N tasks (1000, since Slurm takes 1001 unless it is told
otherwise), and begins when the one before it has succeeded. It prints a line for each job, the last one's number last.

`run` is what a task does: every action whose number in its stage is TASK modulo TASKS. Each runs in an empty folder on the
worker that gets the declared inputs and nothing else, with the declared environment and nothing else; then what it was to
write is there and nothing else, or the task fails; then that is put into the store, each file whole or not at all.
"""
import argparse
import json
import os
import shlex
import shutil
import subprocess
import sys
import tempfile


def read_actions(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)["actions"]


def stages(actions):
    """Lists of actions; those of one need nothing that another of it or of a later one writes."""
    maker = {output: i for i, action in enumerate(actions) for output in action["outputs"]}
    depth = {}

    def depth_of(i, above=()):
        if i in above:
            sys.exit(f"{actions[i]['name']} needs what it makes")
        if i not in depth:
            needed = {maker[path] for path in actions[i]["inputs"] if path in maker}
            depth[i] = 1 + max((depth_of(one, (*above, i)) for one in needed), default=-1)
        return depth[i]

    all_stages = []
    for i, action in enumerate(actions):
        while len(all_stages) <= depth_of(i):
            all_stages.append([])
        all_stages[depth_of(i)].append(action)
    return all_stages


def files_below(folder):
    return {os.path.relpath(os.path.join(where, name), folder) for where, _, names in os.walk(folder) for name in names}


def inside(place, path):
    """Where a relative path of the plan is on the worker."""
    full = os.path.normpath(os.path.join(place, path))
    if not full.startswith(place + os.sep):
        sys.exit(f"{path} leads out of the folder")
    return full


def deliver(made, path):
    """Whole or not at all, though two workers may do it at once."""
    os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
    handle, beside = tempfile.mkstemp(dir=os.path.dirname(path) or ".", prefix=".farm-")
    os.close(handle)
    shutil.copyfile(made, beside)
    os.chmod(beside, 0o644)
    os.replace(beside, path)


def run_action(action, scratch):
    """What went wrong; nothing when all is well."""
    relative = [path for path in action["inputs"] if not os.path.isabs(path)]
    outputs = {os.path.normpath(path) for path in action["outputs"]}
    with tempfile.TemporaryDirectory(dir=scratch) as place:
        for path in relative:
            os.makedirs(os.path.dirname(inside(place, path)), exist_ok=True)
            shutil.copyfile(path, inside(place, path))
        for path in outputs:
            os.makedirs(os.path.dirname(inside(place, path)), exist_ok=True)
        done = subprocess.run(action["command"], cwd=place, env=action["environment"], stdin=subprocess.DEVNULL, check=False)
        if done.returncode != 0:
            return f"ends with {done.returncode}"
        written = files_below(place) - {os.path.normpath(path) for path in relative}
        if written != outputs:
            return f"does not write {sorted(outputs - written)}, and writes {sorted(written - outputs)} undeclared"
        for path in sorted(outputs):
            deliver(os.path.join(place, path), path)
    return None


def run(arguments):
    actions = stages(read_actions(arguments.actions))[arguments.stage]
    for action in actions[arguments.task::arguments.tasks]:
        problem = run_action(action, arguments.scratch)
        if problem:
            sys.exit(f"{action['name']} {problem}")


def submit(arguments):
    here, before = os.path.abspath(__file__), None
    for number, actions in enumerate(stages(read_actions(arguments.actions))):
        tasks = min(len(actions), arguments.tasks)
        command = ["sbatch", "--parsable", f"--array=0-{tasks - 1}", f"--job-name=lacquer-{number}"]
        if before:
            command += [f"--dependency=afterok:{before}", "--kill-on-invalid-dep=yes"]
        scratch = ["--scratch", arguments.scratch] if arguments.scratch else []
        words = ["python3", here, "run", *scratch, "--", arguments.actions, str(number)]
        script = f"#!/bin/sh\nexec {shlex.join(words)} \"$SLURM_ARRAY_TASK_ID\" {tasks}\n"
        done = subprocess.run([*command, *arguments.sbatch], input=script, stdout=subprocess.PIPE, text=True, check=True)
        before = done.stdout.strip().split(";")[0]
        print(f"stage {number}: {len(actions)} actions in {tasks} tasks, job {before}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    verbs = parser.add_subparsers(required=True)
    one = verbs.add_parser("submit")
    one.add_argument("actions")
    one.add_argument("--tasks", type=int, default=1000)
    one.add_argument("--scratch")
    one.add_argument("sbatch", nargs="*")
    one.set_defaults(do=submit)
    one = verbs.add_parser("run")
    one.add_argument("actions")
    for name in ("stage", "task", "tasks"):
        one.add_argument(name, type=int)
    one.add_argument("--scratch")
    one.set_defaults(do=run)
    arguments = parser.parse_args()
    arguments.do(arguments)


if __name__ == "__main__":
    main()
