"""The package over the library of a build: texts, arrays, and what a caller can get wrong."""

import json
import os
import random
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


MATRICES = """{"lacquer_graph": 1, "name": "matrices", "template": "forward",
  "parameters": {"m": {"type": "mat3", "value": [1, 0, 0, 0, 1, 0, 0, 0, 1]}},
  "nodes": [
    {"id": "a", "node": "transformmatrix", "inputs": {"in": [1, 2, 4], "mat": {"parameter": "m"}}},
    {"id": "b", "node": "transformmatrix", "inputs": {"in": {"node": "a"}, "mat": {"attribute": "_FRAME", "type": "mat3"}}},
    {"id": "c", "node": "max", "inputs": {"in1": {"node": "b"}, "in2": [0, 0, 0]}}],
  "outputs": {"emission": {"node": "c"}}}"""


def test_matrices_are_arrays_and_numbers():
    graph = lacquer.Graph.from_json(MATRICES)
    frames = np.stack([np.eye(3).ravel(), 2 * np.eye(3).ravel()])
    assert graph.parameters()[0]["value"] == [1, 0, 0, 0, 1, 0, 0, 0, 1]
    assert np.allclose(graph.evaluate({"_FRAME": frames}).rgba[:, :3], [[1, 2, 4], [2, 4, 8]])
    swapped = [0, 0, 1, 0, 1, 0, 1, 0, 0]
    sweep = graph.evaluate({"_FRAME": frames, "m": np.stack([np.eye(3).ravel(), swapped])})
    assert np.allclose(sweep.rgba[:, :3], [[1, 2, 4], [8, 4, 2]])
    graph.set_parameter("m", swapped)
    assert np.allclose(graph.evaluate([{"_FRAME": list(frames[0])}]).rgba[0, :3], [4, 2, 1])
    with pytest.raises(lacquer.Error):
        graph.set_parameter("m", [1, 2, 3])


def test_evaluate_takes_arrays(coat):
    generator = np.random.default_rng(7)
    count = 300
    directions = {}
    for name in ("n", "v", "l"):
        rows = generator.normal(size=(count, 3)) + [0, 0, 3]
        directions[name] = rows / np.linalg.norm(rows, axis=1)[:, None]
    light = np.array([1, 0.5, 0.25])
    listed = [{name: rows[i] for name, rows in directions.items()} | {"light": light} for i in range(count)]
    for engine in ("double", "float"):
        expected = coat.evaluate(0, listed, engine=engine)
        answer = coat.evaluate(0, {**directions, "light": light}, engine=engine)
        assert answer.material == expected.material and answer.discarded.shape == (count,)
        # A text of floats has nine digits, which are all that they have.
        exact = np.float64 if engine == "double" else np.float32
        assert (answer.rgba.astype(exact) == expected.rgba.astype(exact)).all()
    # A view of floats, backwards.
    floats = {name: rows.astype(np.float32)[::-1] for name, rows in directions.items()}
    assert np.allclose(coat.evaluate(0, {**floats, "light": light}).rgba, expected.rgba[::-1], rtol=1e-4, atol=1e-6)
    with pytest.raises(ValueError, match="different lengths"):
        coat.evaluate(0, {"n": directions["n"], "v": directions["v"][:2]})
    with pytest.raises(lacquer.Error, match="not-unit"):
        coat.evaluate(0, {"v": [[0, 0, 1], [0, 0, 2]]})


def test_a_parameter_that_is_an_array_is_a_sweep(coat):
    graph = coat.graph(0, attributes=lacquer.ATTRIBUTES[:7])
    point = {"v": [0, 0.6, 0.8], "l": [0, -0.6, 0.8]}
    roughness = np.linspace(0.1, 1, 10)
    for engine in ("double", "float"):
        swept = graph.evaluate({**point, "coat_roughness_factor": roughness}, engine=engine).rgba
        for value, row in zip(roughness, swept):
            graph.set_parameter("coat_roughness_factor", value)
            expected = graph.evaluate([point], engine=engine).rgba[0]
            assert (expected.astype(np.float32) == row.astype(np.float32)).all()
    with pytest.raises(lacquer.Error, match="out-of-range"):
        graph.evaluate({**point, "coat_roughness_factor": [0.5, 1.5]})
    with pytest.raises(lacquer.Error, match="no-such-parameter"):
        graph.evaluate({**point, "coat_roughnes_factor": [0.5, 1]})


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


class Session:
    """A tool's session: what it does to a graph in its hundred steps, each an edit in its JSON form."""

    def __init__(self, graph):
        self.graph, self.random = graph, random.Random(3)

    def users(self, node):
        """What takes values from a node, as the edits that connect it again."""
        found = [{"do": "connect", "node": user["id"], "input": name, "source": source}
                 for user in self.graph.nodes() for name, source in user["inputs"].items()]
        found += [{"do": "set_output", "output": name, "source": source} for name, source in self.graph.outputs().items()]
        return [edit for edit in found if isinstance(edit["source"], dict) and edit["source"].get("node") == node]

    def set_value(self):
        parameter = self.random.choice(self.graph.parameters())
        low, high = parameter.get("range", [None, None])
        low = 0 if low is None else low
        high = low + 1 if high is None else high
        value = parameter["value"]
        if isinstance(value, bool):
            value = not value
        elif isinstance(value, list):
            value = [self.random.uniform(low, high) for _ in value]
        else:
            value = self.random.uniform(low, high)
        return {"do": "set_value", "parameter": parameter["name"], "value": value}

    def add_copy(self, step):
        """A node like one that is used, beside it."""
        model = self.random.choice([node for node in self.graph.nodes() if "node" in node and self.users(node["id"])])
        self.copied, self.copy = model["id"], f"tool.n{step}"
        return {"do": "add_node", "node": {"id": self.copy, "node": model["node"], "inputs": model["inputs"]}}

    def use_copy(self):
        edit = self.random.choice(self.users(self.copied))
        return {**edit, "source": {**edit["source"], "node": self.copy}}

    def disconnect(self):
        """An input that has a default; no texture falls out of use."""
        inputs = [(node["id"], one) for node in self.graph.nodes() for one in self.graph.sockets(node["id"])["inputs"]]
        plain = [(node, one["name"]) for node, one in inputs if one.get("optional") and (
            isinstance(one["source"], float) or isinstance(one["source"], dict) and "parameter" in one["source"])]
        if not plain:
            return self.set_value()
        node, name = self.random.choice(plain)
        return {"do": "disconnect", "node": node, "input": name}

    def edit(self, step):
        kind = step % 10
        if kind == 1:
            return self.add_copy(step)
        if kind == 2:
            return self.use_copy()
        if kind == 3:
            before, self.copy = self.copy, f"my.n{step}"
            return {"do": "rename_node", "node": before, "to": self.copy}
        if kind == 4:
            self.group = f"group_{step}"
            return {"do": "make_group", "nodes": [self.copy], "group": self.group, "node": "instance"}
        if kind == 5:
            return {"do": "set_ui", "group": self.group, "ui": {"x": step, "note": "ä"}}
        if kind == 6:
            return [{"do": "expand", "node": "instance"}, {"do": "remove_group", "group": self.group}]
        if kind == 7:
            return self.disconnect()
        return self.set_value()

    def refused(self):
        """What cannot be done raises, and changes nothing."""
        graph, before = self.graph, self.graph.to_text()
        node = graph.nodes()[0]["id"]
        for match, wrong in {
            "duplicate-name": lambda: graph.add_node(node, "schlick"),
            "unknown-input": lambda: graph.connect(node, "no_such_input", 1),
            "no-such-node": lambda: graph.rename_node("nobody", "body"),
            "unknown-port": lambda: graph.set_output("nowhere", 1),
            "unknown-group": lambda: graph.add_instance("x", "no_such_group"),
            "unknown-edit": lambda: graph.edit([{"do": "set_name", "name": "x"}, {"do": "fly"}]),
        }.items():
            with pytest.raises(lacquer.Error, match=match):
                wrong()
        assert graph.to_text() == before


def test_graph_is_edited_for_a_hundred_steps(coat):
    """After each step the colours are those of the file that the graph is saved to, and all of them are taken back."""
    graph = coat.graph(0, attributes=lacquer.ATTRIBUTES[:7])
    session = Session(graph)
    texels = {"texels": [f"{texture['name']}=0.2,0.4,0.6,0.8" for texture in graph.textures()]}
    points = [{"v": [0, 0.6, 0.8], "l": [0.6, 0, 0.8], "env": [0.3, 0.4, 0.5]}]
    essl = {"targets": ["essl"], "validate": False}
    shader = graph.generate(essl)
    start, back, seen, kept = graph.to_text(), [], set(), 0
    for step in range(100):
        if step % 10 == 9:
            session.refused()
        else:
            back.append(graph.edit(session.edit(step)))
        saved = lacquer.Graph.from_json(graph.to_text())
        colors = saved.evaluate(points, options=texels).rgba.tobytes()
        assert graph.evaluate(points, options=texels).rgba.tobytes() == colors
        seen.add(colors)
        change, old, packed = graph.changes(), shader, b""
        if change != "program":
            packed = shader.pack_graph(graph)
        shader = graph.generate(essl)
        assert graph.changes() == "nothing"
        if change != "program":
            assert shader.id == old.id and shader.pack() == packed
            kept += 1
    assert 33 < kept < 100 and len(seen) > 10
    for edit in reversed(back):
        graph.edit(edit)
    assert graph.to_text() == start


def test_pack_takes_the_numbers_of_an_edited_graph(coat):
    graph = coat.graph(0)
    shader = graph.generate({"targets": ["essl"], "validate": False})
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


def test_environments_are_filtered(tmp_path):
    pixels = b"".join(bytes([16 * i - 1, 64, 32, 129]) for i in range(1, 9))
    picture = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n" + pixels
    made = lacquer.filter_environment(picture, size=32, samples=64)
    assert made["environment_max_lod"] == 2 and made["textures"]["environment_specular"]["levels"] == 3
    assert list(made["files"]) == list(made["textures"])
    assert all(file.startswith(b"\xabKTX 20") for file in made["files"].values())
    (tmp_path / "sky.hdr").write_bytes(picture)
    assert lacquer.filter_environment(tmp_path / "sky.hdr", size=32, samples=64) == made
    draft = lacquer.filter_environment(picture, draft=True)
    assert [draft["textures"][slot]["size"] for slot in ("environment_specular", "environment_dfg")] == [64, 32]
    with pytest.raises(lacquer.Error) as error:
        lacquer.filter_environment(picture[:-1], name="cut.hdr")
    assert error.value.messages[0].file == "cut.hdr"


def test_light_profiles(tmp_path):
    lamp = tmp_path / "lamp.ies"
    lamp.write_text("IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 10\n0 180\n0\n100 50\n")
    found = lacquer.light_profiles([lamp], tmp_path / "lamp.ktx2", 16)
    assert found["profiles"][0]["peak"] == 100 and found["profiles"][0]["height"] == 1
    assert (tmp_path / "lamp.ktx2").stat().st_size > 16 * 2
    assert "output" not in lacquer.light_profiles([lamp, lamp])
    with pytest.raises(lacquer.Error):
        lacquer.light_profiles([tmp_path / "none.ies"])
    for sides in ({"width": -1}, {"height": -1}, {"width": 2**32}):
        with pytest.raises(ValueError, match="from 0 to 2048"):
            lacquer.light_profiles([lamp], **sides)
    with pytest.raises(lacquer.Error, match="from 2 to 2048 texels"):
        lacquer.light_profiles([lamp], width=1)


def test_materials_of_other_tools(tmp_path):
    coat = ROOT / "examples/coat.gltf"
    text = lacquer.to_materialx(coat, ["Darkening"], "open_pbr_surface")
    assert text.count("<surfacematerial") == 1 and "<open_pbr_surface" in text
    lacquer.convert(tmp_path / "coat.mtlx", coat)
    scene = lacquer.Scene.load(tmp_path / "coat.mtlx")
    assert scene.materials == lacquer.Scene.load(coat).materials
    with pytest.raises(lacquer.Error) as error:
        lacquer.to_materialx(coat, surface="phong")
    assert error.value.messages[0].code == "unknown-surface"

    (tmp_path / "ramp.mtlx").write_text("""<materialx version="1.39">
      <ramplr name="across" type="color3"><input name="valuel" type="color3" value="0.1, 0.2, 0.9"/></ramplr>
      <gltf_pbr name="shader" type="surfaceshader">
        <input name="base_color" type="color3" nodename="across"/></gltf_pbr>
      <surfacematerial name="Ramp" type="material">
        <input name="surfaceshader" type="surfaceshader" nodename="shader"/></surfacematerial></materialx>""")
    baked = lacquer.bake(tmp_path / "ramp.gltf", tmp_path / "ramp.mtlx", size=8)
    assert baked["textures"] == 1 and Path(baked["output"]) == tmp_path / "ramp.gltf"
    assert [Path(image).is_file() for image in baked["images"]] == [True]
    with pytest.raises(lacquer.Error):
        lacquer.bake(tmp_path / "coat.gltf", coat)
    alone = lacquer.bake(tmp_path / "across.ktx2", tmp_path / "ramp.mtlx", size=4, nodes=["across"], levels=True)
    assert alone["output"] == "" and len(alone["images"]) == 1
    with pytest.raises(lacquer.Error) as error:
        lacquer.bake(tmp_path / "across.ktx2", tmp_path / "ramp.mtlx", texels=4)
    assert error.value.messages[0].code == "unknown-option"
    lost = lacquer.convert(tmp_path / "open.mtlx", tmp_path / "ramp.mtlx", surface="open_pbr_surface", measured=True, size=16)
    assert [each["material"] for each in lost["differences"]] == ["Ramp"]


def test_scenes_as_texts_of_other_tools(tmp_path):
    text = """<materialx version="1.39">
      <nodegraph name="NG">
        <ramplr name="across" type="color3"><input name="valuel" type="color3" value="0.1, 0.2, 0.9"/></ramplr>
        <output name="out" type="color3" nodename="across"/></nodegraph>
      <gltf_pbr name="shader" type="surfaceshader">
        <input name="base_color" type="color3" nodegraph="NG" output="out"/></gltf_pbr>
      <surfacematerial name="Ramp" type="material">
        <input name="surfaceshader" type="surfaceshader" nodename="shader"/></surfacematerial></materialx>"""
    scene = lacquer.Scene.read(text.encode(), "ramp.mtlx")
    gltf = json.loads(scene.to_gltf(size=4))
    assert "KHR_texture_procedurals" in gltf["extensions"]
    (tmp_path / "ramp.mtlx").write_text(text)
    assert json.loads(lacquer.to_gltf(tmp_path / "ramp.mtlx", size=4)) == gltf
    assert 'value="0.1, 0.2, 0.9"' in scene.to_materialx()
    graph = scene.graph(0)
    graph.set_parameter("NG_across_valuel", [0.5, 0.25, 0.125])
    assert 'value="0.5, 0.25, 0.125"' in scene.to_materialx(edited={0: graph})
    main = """<materialx version="1.39"><xi:include href="lib/ramp.mtlx"/></materialx>"""
    options = {"document_texts": {"lib/ramp.mtlx": text}}
    assert lacquer.Scene.read(main.encode(), "main.mtlx", options).materials == ["Ramp"]
    with pytest.raises(lacquer.Error) as error:
        lacquer.Scene.read(main.encode(), "main.mtlx", {"document_texts": {"ramp.mtlx": text}})
    assert error.value.messages[0].code == "include-missing"
    studio = """<materialx version="1.39"><nodedef name="ND" node="mine"><output name="out" type="surfaceshader"/></nodedef>
      <nodegraph name="NG" nodedef="ND"><surface_unlit name="s" type="surfaceshader"/>
      <output name="out" type="surfaceshader" nodename="s"/></nodegraph></materialx>"""
    own = b"""<materialx version="1.39"><mine name="s" type="surfaceshader"/></materialx>"""
    assert lacquer.Scene.read(own, "own.mtlx", {"materialx_texts": {"studio.mtlx": studio}}).materials == ["s"]
    (tmp_path / "studio").mkdir()
    (tmp_path / "studio" / "mine.mtlx").write_text(studio)
    assert lacquer.Scene.read(own, "own.mtlx", {"materialx_directories": [str(tmp_path / "studio")]}).materials == ["s"]


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


def test_wrong_words_say_which_are_right(coat):
    shader = coat.graph(0).generate({"targets": ["essl"], "validate": False})
    for call, right in (
        (lambda: shader.text("essl", "middle"), "vertex, fragment"),
        (lambda: shader.spirv("middle"), "vertex, fragment"),
        (lambda: coat.evaluate(0, [], engine="quad"), "double, float"),
        (lambda: coat.graph(0).evaluate({"n": np.zeros((1, 3))}, engine="quad"), "double, float"),
        (lambda: coat.graph(0, attributes=["NORMALS"]), "NORMAL, TANGENT"),
    ):
        with pytest.raises(lacquer.Error, match=right) as raised:
            call()
        assert raised.value.messages[0].code == "unknown-name"


def test_notebooks_show_balls(coat):
    import struct
    import zlib

    def pixels(png):
        assert png[:8] == b"\x89PNG\r\n\x1a\n"
        width, height = struct.unpack(">II", png[16:24])
        at, data = 8, b""
        while at < len(png):
            size, kind = struct.unpack(">I4s", png[at:at + 8])
            assert struct.unpack(">I", png[at + 8 + size:at + 12 + size])[0] == zlib.crc32(png[at + 4:at + 8 + size])
            data += png[at + 8:at + 8 + size] if kind == b"IDAT" else b""
            at += 12 + size
        rows = np.frombuffer(zlib.decompress(data), np.uint8).reshape(height, 1 + 3 * width)
        assert not rows[:, 0].any()
        return rows[:, 1:].reshape(height, width, 3)

    assert np.array_equal(pixels(coat.graph(0)._repr_png_()), coat.graph(0).preview(192))
    shown = pixels(coat._repr_png_())
    assert shown.shape == (128, 128 * min(len(coat.materials), 6), 3)
    assert np.array_equal(shown[:, 128:256], coat.preview(1, 128))
