"""The package over the library of a build: texts, arrays, and what a caller can get wrong."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import lacquer

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "examples").glob("*.gltf"))
EXTENSIONS = {"glsl": "glsl", "glsl-gl": "glsl", "essl": "glsl", "hlsl": "hlsl"}


@pytest.fixture
def coat():
    return lacquer.Scene.load(ROOT / "examples/coat.gltf")


@pytest.fixture(scope="session")
def made(tmp_path_factory):
    """What the program beside the library makes of the examples."""
    folder = tmp_path_factory.mktemp("made")
    program = Path(os.environ["LACQUER_LIBRARY"]).parent / "lacquer"
    targets = ",".join(["spirv", *EXTENSIONS])
    subprocess.run([program, "gen", "-q", "--no-validate", *EXAMPLES, "-o", folder, "--target", targets], check=True)
    return folder


@pytest.mark.parametrize("file", EXAMPLES, ids=lambda file: file.name)
def test_texts_are_those_of_the_program(file, made):
    entries = json.loads((made / "manifest.json").read_text())["files"]
    entry = next(entry for entry in entries if Path(entry["source"]).name == file.name)
    scene = lacquer.Scene.read(file.read_bytes(), str(file))
    compared = 0
    for material in entry["materials"]:
        assert scene.materials[material["index"]] == material["name"]
        for use in material["uses"]:
            assert sorted(use["attributes"]) in [sorted(names) for names in scene.uses(material["index"])]
            graph = scene.graph(material["index"], attributes=use["attributes"])
            shader = graph.generate({"validate": False, "targets": ["spirv", *EXTENSIONS]})
            assert shader.id == use["shader"]
            for stage, short in (("vertex", "vert"), ("fragment", "frag")):
                for target, extension in EXTENSIONS.items():
                    file = made / target / f"{shader.id}.{short}.{extension}"
                    assert shader.text(target, stage) == file.read_text(), file
                words = (made / "spirv" / f"{shader.id}.{short}.spv").read_bytes()
                assert shader.spirv(stage).tobytes() == words
                compared += 1
    assert compared > 0


def test_evaluate_gives_arrays(coat):
    points = [{"v": np.array([0, 0, 1]), "l": [0, 0.6, 0.8]}, {"v": [0, 0.6, 0.8]}]
    answer = coat.evaluate(0, points)
    assert answer.rgba.shape == (2, 4) and answer.rgba.dtype == np.float64
    assert (answer.rgba[:, :3] > 0).all() and not answer.discarded.any()
    rounded = coat.evaluate(0, points, engine="float")
    assert rounded.engine == "float"
    assert np.allclose(answer.rgba, rounded.rgba, rtol=1e-4) and (answer.rgba != rounded.rgba).any()


def test_preview_is_a_picture(coat):
    picture = coat.preview(0, 32)
    assert picture.shape == (32, 32, 3) and picture.dtype == np.uint8
    assert (picture[0, 0] == picture[0, 31]).all() and (picture[16, 16] != picture[0, 0]).any()


def test_graph_shows_what_its_material_shows(coat):
    graph = coat.graph(0, attributes=lacquer.ATTRIBUTES[:7])  # what points have: NORMAL to TEXCOORD_3
    points = [{"v": [0, 0, 1], "l": [0, 0.6, 0.8], "env": [1, 0.5, 0.25]}]
    answer = graph.evaluate(points)
    assert answer.profile is None and (answer.rgba == coat.evaluate(0, points).rgba).all()
    assert (graph.preview(32) == coat.preview(0, 32)).all()
    parameter = next(p for p in graph.parameters() if p["name"] == "coat_roughness_factor")
    graph.set_parameter(parameter["name"], 0.75)
    assert (graph.evaluate(points).rgba != answer.rgba).any()
    with pytest.raises(lacquer.Error, match="graph-is-built"):
        graph.evaluate(points, options={"profile": "physical"})


def test_pack_takes_values_by_name(coat):
    shader = coat.graph(0).generate({"targets": ["essl"], "validate": False})
    today = shader.pack()
    assert len(today) == shader.uniform_size > 0
    assert shader.pack({"coat_roughness_factor": 0.25, "no_such_factor": 1}) != today
    with pytest.raises(lacquer.Error, match="wrong-count"):
        shader.pack({"coat_roughness_factor": [1, 2]})


def test_graph_is_edited_for_a_hundred_steps(coat):
    """After each step the colours are those of the file that the graph is saved to."""
    graph = coat.graph(0, attributes=lacquer.ATTRIBUTES[:7])
    texels = {"texels": [f"{texture['name']}=0.2,0.4,0.6,0.8" for texture in graph.textures()]}
    points = [{"v": [0, 0.6, 0.8], "l": [0.6, 0, 0.8], "env": [0.3, 0.4, 0.5]}]
    shader = graph.generate({"targets": ["essl"], "validate": False})
    assert graph.changes() == "nothing"
    start, back = graph.to_text(), []
    for step in range(100):
        nodes = graph.nodes()
        node = nodes[7 * step % len(nodes)]
        parameters = graph.parameters()
        parameter = parameters[step % len(parameters)]
        edits = [
            {"do": "rename_node", "node": node["id"], "to": f"my.n{step}"},
            {"do": "set_value", "parameter": parameter["name"], "value": parameter["value"]},
            {"do": "make_group", "nodes": [node["id"]], "group": f"g{step}", "node": node["id"]},
            {"do": "set_ui", "node": node["id"], "ui": {"x": step}},
        ]
        back.append(graph.edit(edits[step % len(edits)]))
        saved = lacquer.Graph.from_json(graph.to_text())
        assert (graph.evaluate(points, options=texels).rgba == saved.evaluate(points, options=texels).rgba).all()
        assert graph.changes() in ("nothing", "numbers")
    assert shader.pack_graph(graph) == shader.pack()
    for edit in reversed(back):
        graph.edit(edit)
    assert graph.to_text() == start
    graph.set_parameter("coat_roughness_factor", 0.75)
    assert graph.changes() == "numbers"
    assert shader.pack_graph(graph) == shader.pack({"coat_roughness_factor": 0.75}) != shader.pack()


def test_graph_is_listed_and_grouped(coat):
    graph = coat.graph(0)
    before = graph.to_text()
    node = graph.nodes()[0]
    assert set(node["inputs"]) == {i["name"] for i in graph.sockets(node["id"])["inputs"] if i["source"] is not None}
    assert graph.outputs() == {i["name"]: i["source"] for i in graph.sockets()["inputs"] if i["source"] is not None}
    graph.make_group([node["id"]], "folded", "it")
    assert graph.groups() == ["folded"]
    assert [inner["id"] for inner in graph.nodes("folded")] == [node["id"]]
    assert graph.outputs("folded")
    graph.add_instance("again", "folded")
    graph.rename_node("again", "more")
    graph.remove_node("more")
    graph.expand("it")
    graph.add_group("whole", coat.graph(0))
    with pytest.raises(lacquer.Error, match="not-connected"):
        graph.disconnect(graph.nodes()[0]["id"], "nothing")
    graph.remove_output(next(iter(graph.outputs())))
    assert graph.to_text() != before
    with pytest.raises(lacquer.Error, match="no-such-node"):
        graph.sockets("nobody")


def test_graph_is_edited_and_checked(coat):
    graph = coat.graph(0)
    assert lacquer.Graph.from_json(graph.to_json()).to_text() == graph.to_text()
    graph.add_node("mine", "schlick")
    graph.connect("mine", "F0", 0.04)
    graph.remove_node("mine")
    assert graph.check() == []
    with pytest.raises(lacquer.Error, match="no-such-node"):
        graph.remove_node("mine")
    with pytest.raises(lacquer.Error, match="unknown-port"):
        graph.set_output("nowhere", 1)
    for node in graph.nodes():
        graph.remove_node(node["id"])
    assert {m.level for m in graph.check()} == {"error"}
    assert "; fragment" in coat.graph(0).dump()


def test_errors_have_the_librarys_messages(coat):
    with pytest.raises(lacquer.Error) as error:
        lacquer.Scene.read(b'{"asset": ', "broken.gltf")
    message = error.value.messages[0]
    assert (message.level, message.file, message.line) == ("error", "broken.gltf", 1)
    for call, code in (
        (lambda: lacquer.Scene.load("no-such.gltf"), "file-unreadable"),
        (lambda: coat.find("nobody"), "no-such-material"),
        (lambda: coat.graph(99), "no-such-material"),
        (lambda: coat.graph(0, {"colour": 1}), "unknown-option"),
        (lambda: coat.evaluate(0, [{"w": 1}]), "unknown"),
        (lambda: coat.preview(0, 1), "out-of-range"),
        (lambda: lacquer.environment_dfg(1), "out-of-range"),
    ):
        with pytest.raises(lacquer.Error, match=code):
            call()


def test_names_are_not_cut():
    coat = lacquer.Scene.load(ROOT / "examples/coat.gltf")
    graph = coat.graph(0)
    for call in (
        lambda: lacquer.Scene.load(str(ROOT / "examples/coat.gltf") + "\0.txt"),
        lambda: lacquer.Scene.read(b"{}", "a\0b"),
        lambda: coat.find("Coat\0"),
        lambda: graph.set_parameter("coat_factor\0", 1),
        lambda: graph.set_range("coat_factor\0", 0, 1),
        lambda: graph.add_node("x\0", "schlick"),
        lambda: graph.generate({"targets": ["essl"]}).pack({"coat_factor\0x": 1}),
    ):
        with pytest.raises(ValueError, match="NUL"):
            call()


def test_indices_do_not_wrap():
    coat = lacquer.Scene.load(ROOT / "examples/coat.gltf")
    for call in (coat.graph, coat.uses, coat.preview, lambda i: coat.evaluate(i, [])):
        for index in (-1, 2**64, 2**64 + 1, -(2**64)):
            with pytest.raises(IndexError):
                call(index)
        with pytest.raises(TypeError):
            call(0.5)


def test_numbers_outside_of_ranges():
    graph = lacquer.Scene.load(ROOT / "examples/coat.gltf").graph(0)
    shader = graph.generate({"targets": ["essl"], "validate": False})
    said = []
    assert shader.pack({"coat_roughness_factor": 1e300}, said) == shader.pack({"coat_roughness_factor": 1})
    assert shader.pack({"coat_roughness_factor": float("nan")}, said) == shader.pack()
    assert [one.code for one in said] == ["out-of-range", "not-a-number"]
    for call in (
        lambda: graph.set_parameter("coat_factor", float("nan")),
        lambda: graph.set_parameter("coat_factor", 1e39),
        lambda: graph.set_range("coat_factor", float("inf"), float("inf")),
    ):
        with pytest.raises(lacquer.Error):
            call()
    assert graph.generate({"targets": ["essl"], "validate": False}).uniform_size > 0


def test_tables_and_nodes():
    table = lacquer.environment_dfg(16)
    assert table.shape == (16, 16, 2) and (table.sum(axis=2) <= 1.001).all() and table.max() > 0.9
    assert lacquer.environment_sheen(4).shape == (4, 4, 2)
    assert any(node["name"] == "schlick" for node in lacquer.nodes()["nodes"])
    assert lacquer.version().count(".") == 2


def test_handles_are_freed():
    # Two hundred scenes, graphs and shaders: what is not freed shows as memory of the process.
    import resource

    data = (ROOT / "examples/coat.gltf").read_bytes()

    def work():
        shader = lacquer.Scene.read(data).graph(0).generate({"targets": ["essl"], "validate": False})
        assert shader.uniform_size > 0

    for _ in range(50):
        work()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for _ in range(200):
        work()
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 4096


def test_example_runs(tmp_path):
    picture = tmp_path / "coat.ppm"
    done = subprocess.run([sys.executable, ROOT / "python/examples/coat.py", picture], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert picture.read_bytes().startswith(b"P6")
    assert "forward-coat-" in done.stdout
