"""Lacquer in Python: glTF materials to shaders. The way is Scene -> Graph -> Shader.

What cannot be done raises Error, which has the library's messages; what is worth knowing is appended to the list
`messages` that every call takes.
"""

from __future__ import annotations

import ctypes
import json
import operator
import os
import struct
import zlib
from ctypes import byref, c_char_p, c_double, c_float, c_size_t, c_uint8
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Union

import numpy as np
from numpy.typing import NDArray

from ._native import Array, Colors, Value, load

__all__ = [
    "ATTRIBUTES", "Error", "Evaluation", "Graph", "Message", "Scene", "Shader", "bake", "check_nodes", "convert", "environment_dfg",
    "environment_sheen", "filter_environment", "light_profiles", "nodes", "to_gltf", "to_materialx", "version",
]

_lib = load()

# By bit. JOINTS_n come with WEIGHTS_n; the last three are morph targets, instances, and positions or texture coordinates
# that are stored as integers.
ATTRIBUTES = ("NORMAL", "TANGENT", "COLOR_0", "TEXCOORD_0", "TEXCOORD_1", "TEXCOORD_2", "TEXCOORD_3", "JOINTS_0",
              "JOINTS_1", "MORPH_TARGETS", "INSTANCES", "QUANTIZED")
_UNUSED = ("NORMAL", "TANGENT", "TEXCOORD_0", "TEXCOORD_1")
_LEVELS = ("note", "warning", "error")
_STAGES = {"vertex": 0, "fragment": 1}
_ENGINES = {"double": 0, "float": 1, "vulkan": 2, "vulkan-glsl": 3, "vulkan-hlsl": 4}
_CHANGES = ("nothing", "numbers", "textures", "program")
_NONE = c_size_t(-1).value

Options = Mapping[str, Any]
Numbers = Union[float, Sequence[float]]


@dataclass(frozen=True)
class Message:
    """Something that is wrong with the input, or worth knowing."""

    level: str
    code: str
    file: str
    pointer: str
    line: int
    column: int
    message: str
    help: str
    text: str

    def __str__(self) -> str:
        return self.text


class Error(Exception):
    """What a call raises that cannot do what it is for."""

    def __init__(self, messages: List[Message]):
        super().__init__("\n".join(m.text for m in messages if m.level == "error") or "the call failed")
        self.messages = messages


def _wrong(code: str, message: str, help: str = "") -> Error:
    """What this package finds itself."""
    text = f"error: {message} [{code}]" + (f"\n  help: {help}" if help else "")
    return Error([Message("error", code, "", "", 0, 0, message, help, text)])


def _chosen(names: Mapping[str, int], name: str, what: str) -> int:
    """The number of a name; raises, and says which there are."""
    if name not in names:
        raise _wrong("unknown-name", f"there is no {what} {name!r}", "it is one of " + ", ".join(names))
    return names[name]


def _text(text: str) -> bytes:
    """UTF-8 for a C string, which would end at a NUL."""
    if "\0" in text:
        raise ValueError(f"a NUL stands in {text!r}")
    return text.encode()


def _path(path: Union[str, "os.PathLike[str]"]) -> bytes:
    name = os.fsencode(path)
    if b"\0" in name:
        raise ValueError(f"a NUL stands in {path!r}")
    return name


def _index(index: int) -> int:
    """An index for a size_t, which would wrap. Whether there is such a material the library says."""
    number = operator.index(index)
    if not 0 <= number < _NONE:
        raise IndexError(f"{number} is no index: they begin at 0")
    return number


def _sized(function: Callable[..., Optional[int]], *arguments: Any) -> str:
    size = c_size_t()
    at = function(*arguments, byref(size))
    return ctypes.string_at(at, size.value).decode("utf-8", "replace") if at else ""


def _taken(handle: Optional[int]) -> str:
    if not handle:
        return ""
    text = ctypes.string_at(_lib.lacquer_text_data(handle), _lib.lacquer_text_size(handle))
    _lib.lacquer_text_free(handle)
    return text.decode("utf-8", "replace")


def _said(handle: int) -> List[Message]:
    def part(index: int, which: int) -> str:
        return _sized(_lib.lacquer_message_part, handle, index, which)

    return [
        Message(_LEVELS[_lib.lacquer_message_level(handle, i)], part(i, 0), part(i, 1), part(i, 2),
                _lib.lacquer_message_line(handle, i), _lib.lacquer_message_column(handle, i), part(i, 3), part(i, 4),
                part(i, 5))
        for i in range(_lib.lacquer_messages_count(handle))
    ]


def _calling(options: Optional[Options], messages: Optional[List[Message]], call: Callable[[int, Optional[int]], Any]) -> Any:
    """What `call` gives with messages and options; raises where that is nothing."""
    handle = _lib.lacquer_messages_new()
    made = None
    try:
        result = None
        if options is not None:
            text = json.dumps(dict(options)).encode()
            made = _lib.lacquer_options_new(text, len(text), handle)
        if options is None or made:
            result = call(handle, made)
        said = _said(handle)
        if messages is not None:
            messages.extend(said)
        if not result:
            raise Error(said)
        return result
    finally:
        _lib.lacquer_options_free(made)
        _lib.lacquer_messages_free(handle)


class _Handle:
    _free: Callable[[Optional[int]], None]

    def __init__(self, at: int):
        self._at: Optional[int] = at

    def __del__(self) -> None:
        at, self._at = getattr(self, "_at", None), None
        if at:
            type(self)._free(at)


class Shader(_Handle):
    """The code of a graph."""

    _free = _lib.lacquer_shader_free

    @property
    def id(self) -> str:
        """Equal for equal code and different for different code: "forward-coat-1f0a9b1c2d3e4f50"."""
        return _lib.lacquer_shader_id(self._at).decode()

    @property
    def has_vertex_stage(self) -> bool:
        return bool(_lib.lacquer_shader_has_vertex_stage(self._at))

    def text(self, target: str, stage: str = "fragment") -> str:
        """Empty for a target that was not asked for or that has no text."""
        return _sized(_lib.lacquer_shader_text, self._at, _text(target), _chosen(_STAGES, stage, "stage"))

    def spirv(self, stage: str = "fragment") -> NDArray[np.uint32]:
        """Words in the machine's byte order; empty when "spirv" was not asked for."""
        count = c_size_t()
        at = _lib.lacquer_shader_spirv(self._at, _chosen(_STAGES, stage, "stage"), byref(count))
        return np.frombuffer(ctypes.string_at(at, 4 * count.value) if at else b"", dtype=np.uint32)

    @property
    def interface(self) -> Dict[str, Any]:
        """Its entry in manifest.json: blocks with their fields, textures, inputs."""
        return json.loads(_sized(_lib.lacquer_shader_interface, self._at))

    @property
    def uniform_size(self) -> int:
        """Bytes of the material's uniform block; 0 when there is none."""
        return _lib.lacquer_shader_uniform_size(self._at)

    def pack(self, values: Optional[Mapping[str, Numbers]] = None, messages: Optional[List[Message]] = None) -> bytes:
        """The preshader: the bytes of the material's uniform block. Parameters that are not given have today's value;
        names that this shader has no parameter of are passed over."""
        rows = (Value * len(values or {}))()
        for row, (name, value) in zip(rows, (values or {}).items()):
            numbers = np.atleast_1d(np.asarray(value, dtype=np.float64)).ravel()
            row.name = _text(name)
            row.numbers = (c_double * len(numbers))(*numbers)
            row.count = len(numbers)
        size = self.uniform_size
        block = (c_uint8 * size)()
        _calling(None, messages, lambda said, _: _lib.lacquer_shader_pack(self._at, rows, len(rows), block, size, said))
        return bytes(block)

    def pack_graph(self, graph: "Graph", messages: Optional[List[Message]] = None) -> bytes:
        """The same with a graph's numbers as they are now: one whose shader this is, Graph.changes() says."""
        size = self.uniform_size
        block = (c_uint8 * size)()
        _calling(None, messages, lambda said, _: _lib.lacquer_shader_pack_graph(self._at, graph._at, block, size, said))
        return bytes(block)


@dataclass(frozen=True)
class Evaluation:
    """Linear colours: `rgba` has a row of four for each point, NaN where a number is not finite."""

    material: str
    engine: str
    profile: Optional[str]  #: of a graph none
    rgba: NDArray[np.float64]
    discarded: NDArray[np.bool_]


def _plain(value: Any) -> Any:
    """Arrays as lists, for JSON."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    raise TypeError(f"{type(value).__name__} is no number, text, list or array")


Points = Union[Sequence[Mapping[str, Any]], Mapping[str, Any]]


def _are_arrays(points: Points) -> bool:
    return isinstance(points, Mapping) and "points" not in points


def _rows(name: str, value: Any) -> NDArray[Any]:
    """Numbers as rows of a point's components: floats and doubles as they lie, all else as doubles."""
    array = np.asarray(value)
    if array.dtype not in (np.float32, np.float64):
        try:
            array = array.astype(np.float64)
        except (TypeError, ValueError):
            raise TypeError(f"{name}: an array of numbers is expected") from None
    if array.ndim == 2 and array.strides[1] != array.itemsize:
        array = np.ascontiguousarray(array)
    return array


# Members of a point that are vectors: an array of one dimension is one for all points. Of other names, parameters and
# attributes among them, it has a number for each.
_VECTORS = ("n", "t", "v", "l", "uv0", "uv1", "uv2", "uv3", "color0", "light", "env", "position", "random")


def _colors_of(points: Mapping[str, Any], call: Callable[[Any, int, int, Any], Any]) -> "tuple[Any, Any]":
    """Arrays of numbers by name: (points, components), or (points,) of what is one number. A number, a vector and an
    array of length 1 are the same for all points."""
    arrays = {name: _rows(name, value) for name, value in points.items()}
    lengths = {}
    for name, array in arrays.items():
        if array.ndim > 2:
            raise ValueError(f"{name}: an array of {array.ndim} dimensions; it has a row for each point")
        one = array.ndim == 0 or (array.ndim == 1 and (name in _VECTORS or "." in name))
        lengths[name] = 1 if one else len(array)
    count = max([1, *lengths.values()])
    wrong = [f"{name} has {length}" for name, length in lengths.items() if length not in (1, count)]
    if wrong or 0 in lengths.values():
        raise ValueError(f"arrays of different lengths: {', '.join(wrong)}; {count} are expected, or 1")
    rows = (Array * len(arrays))()
    for row, (name, array) in zip(rows, arrays.items()):
        several = lengths[name] > 1
        row.name = _text(name)
        row.numbers = array.ctypes.data
        row.is_double = int(array.dtype == np.float64)
        row.components = array.shape[1] if array.ndim == 2 else 1 if several else max(array.size, 1)
        row.stride = array.strides[0] if several else 0
    rgba = np.zeros((count, 4), dtype=np.float64)
    discarded = np.zeros(count, dtype=np.uint8)
    to = Colors(rgba.ctypes.data, 1, 0, discarded.ctypes.data)
    call(rows, len(rows), count, byref(to))
    return rgba, discarded.astype(bool)


def _evaluated(points: Points, call: Callable[[bytes], str]) -> Evaluation:
    answer = json.loads(call(json.dumps(points, default=_plain).encode()))
    rgba = np.array(answer["rgba"], dtype=np.float64).reshape(-1, 4)
    discarded = np.array(answer.get("discarded", [False] * len(rgba)), dtype=bool)
    return Evaluation(answer["material"], answer["engine"], answer.get("profile"), rgba, discarded)


def _drawn(pixels: int, call: Callable[[Any, int], Any]) -> NDArray[np.uint8]:
    picture = np.zeros((pixels, pixels, 3), dtype=np.uint8)
    call(picture.ctypes.data_as(ctypes.POINTER(c_uint8)), picture.size)
    return picture


def _png(pixels: NDArray[np.uint8]) -> bytes:
    """A file of rows of sRGB pixels (ISO/IEC 15948)."""
    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    height, width, _ = pixels.shape
    rows = np.concatenate([np.zeros((height, 1), np.uint8), pixels.reshape(height, 3 * width)], axis=1)
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"sRGB", b"\0") + chunk(b"IDAT", zlib.compress(rows.tobytes()))
            + chunk(b"IEND", b""))


class Graph(_Handle):
    """A node graph: one term of the specification is one node. An edit that fails raises, and leaves it as it was. Nodes,
    inputs and outputs of a group are named with the group and a slash: "worn/mix"."""

    _free = _lib.lacquer_graph_free

    @classmethod
    def from_json(cls, graph: Union[str, Mapping[str, Any]], name: str = "graph.json",
                  messages: Optional[List[Message]] = None, options: Optional[Options] = None) -> "Graph":
        """Of the options, "node_directories", which edits are checked against, and "limits"."""
        text = (graph if isinstance(graph, str) else json.dumps(dict(graph))).encode()
        return cls(_calling(options, messages,
                            lambda said, how: _lib.lacquer_graph_read_with(text, len(text), _text(name), how, said)))

    def to_text(self) -> str:
        """The JSON form as the program writes it."""
        return _taken(_lib.lacquer_graph_json(self._at))

    def to_json(self) -> Dict[str, Any]:
        return json.loads(self.to_text())

    def to_dot(self) -> str:
        return _taken(_lib.lacquer_graph_dot(self._at))

    def parameters(self) -> List[Dict[str, Any]]:
        """name, type, value, low, high (None: unbounded), or_zero, pointer, ui of each editable number."""
        return json.loads(_taken(_lib.lacquer_graph_parameters(self._at)))

    def textures(self) -> List[Dict[str, Any]]:
        """name, type, srgb, texture (-1: none), pointer, file, ui, also (pointers of other properties that have its texel) of each."""
        return json.loads(_taken(_lib.lacquer_graph_textures(self._at)))

    def groups(self) -> List[str]:
        """Their names."""
        return json.loads(_taken(_lib.lacquer_graph_groups(self._at)))

    def nodes(self, group: str = "") -> List[Dict[str, Any]]:
        """id, node or group, variant, stage, inputs, ui of the graph's nodes, or of a group's."""
        return json.loads(_taken(_lib.lacquer_graph_nodes(self._at, _text(group))))

    def outputs(self, group: str = "") -> Dict[str, Any]:
        """The ports of the template that are connected, or the outputs of a group, with their sources."""
        return json.loads(_taken(_lib.lacquer_graph_outputs(self._at, _text(group))))

    def sockets(self, node: str = "", messages: Optional[List[Message]] = None) -> Dict[str, Any]:
        """"inputs" and "outputs" of a node, or the template's ports as inputs: name, type, low, high, or_zero, and of
        inputs optional and source."""
        return json.loads(_taken(_calling(
            None, messages, lambda said, _: _lib.lacquer_graph_sockets(self._at, _text(node), said))))

    def add_node(self, id: str, type: str, messages: Optional[List[Message]] = None) -> None:
        self._edit(messages, _lib.lacquer_graph_add_node, id, type)

    def add_instance(self, id: str, group: str, messages: Optional[List[Message]] = None) -> None:
        """A node that is a group of the graph."""
        self._edit(messages, _lib.lacquer_graph_add_instance, id, group)

    def remove_node(self, id: str, messages: Optional[List[Message]] = None) -> None:
        self._edit(messages, _lib.lacquer_graph_remove_node, id)

    def rename_node(self, id: str, to: str, messages: Optional[List[Message]] = None) -> None:
        """And in all that takes values from it."""
        self._edit(messages, _lib.lacquer_graph_rename_node, id, to)

    def connect(self, node: str, input: str, source: Any, messages: Optional[List[Message]] = None) -> None:
        """`source`: 0.5, [1, 0, 0], {"node": "coat.f0"}, {"parameter": "x"}, {"texture": "x"}, {"given": "view"}."""
        self._edit(messages, _lib.lacquer_graph_connect, node, input, json.dumps(source))

    def disconnect(self, node: str, input: str, messages: Optional[List[Message]] = None) -> None:
        """The input has its default again."""
        self._edit(messages, _lib.lacquer_graph_disconnect, node, input)

    def set_output(self, port: str, source: Any, messages: Optional[List[Message]] = None) -> None:
        self._edit(messages, _lib.lacquer_graph_set_output, port, json.dumps(source))

    def remove_output(self, port: str, messages: Optional[List[Message]] = None) -> None:
        self._edit(messages, _lib.lacquer_graph_remove_output, port)

    def make_group(self, nodes: Sequence[str], group: str, instance: str,
                   messages: Optional[List[Message]] = None) -> None:
        """Puts nodes into a new group, and an instance of it in their place."""
        names = _names(nodes)
        _calling(None, messages, lambda said, _: _lib.lacquer_graph_make_group(
            self._at, names, len(names), _text(group), _text(instance), said))

    def add_group(self, group: str, graph: "Graph", messages: Optional[List[Message]] = None) -> None:
        """A graph as a group of this one: its parameters and textures are inputs."""
        _calling(None, messages,
                 lambda said, _: _lib.lacquer_graph_add_group(self._at, _text(group), graph._at, said))

    def expand(self, node: str, messages: Optional[List[Message]] = None) -> None:
        """Puts the nodes of an instance's group in its place."""
        self._edit(messages, _lib.lacquer_graph_expand, node)

    def edit(self, edit: Any, messages: Optional[List[Message]] = None) -> Any:
        """Any edit in its JSON form, or a list of them, all or none (docs/graph-format.md, "Edits"): the edit that takes
        it back, after which the graph has the same bytes."""
        text = json.dumps(edit).encode()
        return json.loads(_taken(_calling(
            None, messages, lambda said, _: _lib.lacquer_graph_edit(self._at, text, len(text), said))))

    def changes(self) -> str:
        """What has changed since generate(), the gravest: "nothing", "numbers" (the bytes of the block), "textures" or
        "program"."""
        return _CHANGES[_lib.lacquer_graph_changes(self._at)]

    def set_parameter(self, name: str, value: Numbers, messages: Optional[List[Message]] = None) -> None:
        numbers = np.atleast_1d(np.asarray(value, dtype=np.float64)).ravel()
        array = (c_double * len(numbers))(*numbers)
        _calling(None, messages, lambda said, _: _lib.lacquer_graph_set_parameter(self._at, _text(name), array,
                                                                                  len(numbers), said))

    def set_range(self, parameter: str, low: float, high: float, or_zero: bool = False,
                  messages: Optional[List[Message]] = None) -> None:
        _calling(None, messages, lambda said, _: _lib.lacquer_graph_set_range(self._at, _text(parameter), low, high,
                                                                              int(or_zero), said))

    def check(self, options: Optional[Options] = None) -> List[Message]:
        """What is wrong with it and worth knowing."""
        messages: List[Message] = []
        try:
            _calling(options, messages, lambda said, how: _lib.lacquer_graph_check(self._at, how, said))
        except Error:
            pass
        return messages

    def generate(self, options: Optional[Options] = None, messages: Optional[List[Message]] = None) -> Shader:
        return Shader(_calling(options, messages, lambda said, how: _lib.lacquer_graph_generate(self._at, how, said)))

    def dump(self, after: str = "", options: Optional[Options] = None, messages: Optional[List[Message]] = None) -> str:
        """The values of the code with their rates, after a pass; after the last without one."""
        return _taken(_calling(options, messages, lambda said, how: _lib.lacquer_graph_dump(self._at, _text(after),
                                                                                           how, said)))

    def evaluate(self, points: Points, engine: str = "double", options: Optional[Options] = None,
                 messages: Optional[List[Message]] = None) -> Evaluation:
        """As Scene.evaluate(), of the graph as it is now."""
        if _are_arrays(points):
            rgba, discarded = _colors_of(points, lambda rows, count, size, to: _calling(
                options, messages, lambda said, how: _lib.lacquer_graph_colors_of(
                    self._at, rows, count, size, _chosen(_ENGINES, engine, "engine"), to, how, said)))
            return Evaluation(self.to_json()["name"], engine, None, rgba, discarded)
        return _evaluated(points, lambda text: _taken(_calling(
            options, messages, lambda said, how: _lib.lacquer_graph_evaluate(self._at, text, len(text), _chosen(_ENGINES, engine, "engine"),
                                                                             how, said))))

    def preview(self, pixels: int = 256, options: Optional[Options] = None,
                messages: Optional[List[Message]] = None) -> NDArray[np.uint8]:
        """As Scene.preview(), of the graph as it is now."""
        return _drawn(pixels, lambda at, size: _calling(
            options, messages, lambda said, how: _lib.lacquer_graph_preview(self._at, pixels, at, size, how, said)))

    def _repr_png_(self) -> bytes:
        """What a notebook shows of it: a ball."""
        return _png(self.preview(192))

    def _edit(self, messages: Optional[List[Message]], function: Callable[..., int], *texts: str) -> None:
        words = [_text(text) for text in texts]
        _calling(None, messages, lambda said, _: function(self._at, *words, said))


class Scene(_Handle):
    """The materials of a glTF file, or of a MaterialX document."""

    _free = _lib.lacquer_scene_free

    @classmethod
    def load(cls, path: Union[str, Path], options: Optional[Options] = None,
             messages: Optional[List[Message]] = None) -> "Scene":
        """Reads .gltf, .glb or .mtlx; buffers and images need not exist."""
        name = _path(path)
        return cls(_calling(options, messages, lambda said, how: _lib.lacquer_scene_load(name, how, said)))

    @classmethod
    def read(cls, data: bytes, name: str = "scene.gltf", options: Optional[Options] = None,
             messages: Optional[List[Message]] = None) -> "Scene":
        """The same from bytes; `name` stands for the file in messages. Such a scene reads no files."""
        return cls(_calling(options, messages, lambda said, how: _lib.lacquer_scene_read(data, len(data), _text(name),
                                                                                        how, said)))

    @property
    def materials(self) -> List[str]:
        """Their names, in order."""
        count = _lib.lacquer_scene_material_count(self._at)
        return [_sized(_lib.lacquer_scene_material_name, self._at, i) for i in range(count)]

    def find(self, name: Optional[str] = None, messages: Optional[List[Message]] = None) -> int:
        """The index of the first material of that name; without one of the only material."""
        text = None if name is None else _text(name)

        def call(said: int, _: Optional[int]) -> int:
            found = _lib.lacquer_scene_find_material(self._at, text, said)
            return 0 if found == _NONE else found + 1

        return _calling(None, messages, call) - 1

    def uses(self, material: int) -> List[List[str]]:
        """Attributes of the primitives that use a material, each kind once."""
        index = _index(material)
        bits = [_lib.lacquer_scene_use(self._at, index, i)
                for i in range(_lib.lacquer_scene_use_count(self._at, index))]
        return [[name for i, name in enumerate(ATTRIBUTES) if use >> i & 1] for use in bits]

    def graph(self, material: int = 0, options: Optional[Options] = None, attributes: Optional[Sequence[str]] = None,
              messages: Optional[List[Message]] = None) -> Graph:
        """On primitives with these attributes; those of its first use where none are named."""
        bits = self._bits(material, attributes)
        return Graph(_calling(options, messages, lambda said, how: _lib.lacquer_scene_graph(self._at, _index(material), bits, how,
                                                                                           said)))

    def properties(self, material: int = 0, options: Optional[Options] = None,
                   attributes: Optional[Sequence[str]] = None,
                   messages: Optional[List[Message]] = None) -> List[Dict[str, Any]]:
        """Of each property of a material its `pointer`, what its `change` is to the shader ("numbers", "textures" or
        "program"), the `name` of the parameter or texture, and of "program" the terms that, as "live" in the options,
        make a number of it."""
        bits = self._bits(material, attributes)
        return json.loads(_taken(_calling(options, messages, lambda said, how: _lib.lacquer_scene_properties(
            self._at, _index(material), bits, how, said))))

    def _bits(self, material: int, attributes: Optional[Sequence[str]]) -> int:
        if attributes is None:
            attributes = next(iter(self.uses(material)), _UNUSED)
        bits = {name: 1 << i for i, name in enumerate(ATTRIBUTES)}
        return sum(_chosen(bits, name, "attribute") for name in set(attributes))

    def to_materialx(self, materials: Sequence[str] = (), surface: str = "",
                     edited: Optional[Mapping[int, "Graph"]] = None, options: Optional[Options] = None,
                     messages: Optional[List[Message]] = None) -> str:
        """As to_materialx(). Of materials whose graphs were `edited`, by their numbers, the document has what
        computes texels in the graph, with its numbers and images."""
        names, of = _names(materials), dict(edited or {})
        numbers = (c_size_t * len(of))(*map(_index, of))
        graphs = (ctypes.c_void_p * len(of))(*(graph._at for graph in of.values()))
        return _taken(_calling(options, messages, lambda said, how: _lib.lacquer_scene_materialx(
            self._at, names, len(names), _text(surface), numbers, graphs, len(of), how, said)))

    def to_gltf(self, materials: Sequence[str] = (), size: int = 256, options: Optional[Options] = None,
                messages: Optional[List[Message]] = None) -> str:
        """As to_gltf()."""
        names, texels = _names(materials), _texels(size)
        return _taken(_calling(options, messages, lambda said, how: _lib.lacquer_scene_gltf(
            self._at, names, len(names), texels, how, said)))

    def evaluate(self, material: int, points: Points, engine: str = "double", options: Optional[Options] = None,
                 messages: Optional[List[Message]] = None) -> Evaluation:
        """Linear colours at points (docs/eval.md): a list of them, or arrays by the members' names, (points, components)
        each; what is there once is for all points. A parameter's array, by its name or pointer, is a sweep."""
        if _are_arrays(points):
            rgba, discarded = _colors_of(points, lambda rows, count, size, to: _calling(
                options, messages, lambda said, how: _lib.lacquer_scene_colors_of(
                    self._at, _index(material), rows, count, size, _chosen(_ENGINES, engine, "engine"), to, how, said)))
            return Evaluation(self.materials[material], engine, (options or {}).get("profile"), rgba, discarded)
        return _evaluated(points, lambda text: _taken(_calling(
            options, messages, lambda said, how: _lib.lacquer_scene_evaluate(
                self._at, _index(material), text, len(text), _chosen(_ENGINES, engine, "engine"), how, said))))

    def preview(self, material: int = 0, pixels: int = 256, options: Optional[Options] = None,
                messages: Optional[List[Message]] = None) -> NDArray[np.uint8]:
        """A lit ball: `pixels` rows of `pixels` by 3, sRGB; from 16 to 2048 pixels."""
        return _drawn(pixels, lambda at, size: _calling(
            options, messages, lambda said, how: _lib.lacquer_scene_preview(self._at, _index(material), pixels, at, size,
                                                                            how, said)))

    def _repr_png_(self) -> Optional[bytes]:
        """What a notebook shows of it: a ball for each material, the first six in a row; nothing where there is none."""
        balls = [self.preview(material, 128) for material in range(min(len(self.materials), 6))]
        return _png(np.concatenate(balls, axis=1)) if balls else None


def version() -> str:
    """The library's: "0.2.0"."""
    return _lib.lacquer_version().decode()


def check_nodes(options: Options) -> List[Message]:
    """What is wrong with the options' own node files and MaterialX definitions, and worth knowing."""
    messages: List[Message] = []
    try:
        _calling(options, messages, lambda said, how: _lib.lacquer_check_nodes(how, said))
    except Error:
        pass
    return messages


def nodes(options: Optional[Options] = None) -> Dict[str, Any]:
    """Nodes, templates, profiles, extensions and their properties, as `lacquer nodes --json`."""
    return json.loads(_taken(_calling(options, None, lambda said, how: _lib.lacquer_nodes(how, said))))


def _names(names: Sequence[str]) -> Any:
    return (c_char_p * len(names))(*map(_text, names))


def to_materialx(file: Union[str, Path], materials: Sequence[str] = (), surface: str = "",
                 options: Optional[Options] = None, messages: Optional[List[Message]] = None) -> str:
    """A MaterialX document of a .gltf, .glb or .mtlx file's materials: those of the names, or all. `surface` is "gltf_pbr",
    "open_pbr_surface", or empty for the one that says more of a material."""
    source, names = _path(file), _names(materials)
    return _taken(_calling(options, messages, lambda said, how: _lib.lacquer_materialx(
        source, names, len(names), _text(surface), how, said)))


def to_gltf(file: Union[str, Path], materials: Sequence[str] = (), size: int = 256, options: Optional[Options] = None,
            messages: Optional[List[Message]] = None) -> str:
    """A glTF file whose procedural textures are KHR_texture_procedurals, each with a baked fallback of `size` by `size` texels
    in it: of a .mtlx file its materials, of a .gltf file the whole, of a graph, .json, its patterns."""
    source, names, texels = _path(file), _names(materials), _texels(size)
    return _taken(_calling(options, messages, lambda said, how: _lib.lacquer_gltf(
        source, names, len(names), texels, how, said)))


def convert(output: Union[str, Path], file: Union[str, Path], materials: Sequence[str] = (), surface: str = "",
            options: Optional[Options] = None, messages: Optional[List[Message]] = None, measured: bool = False,
            picture: Union[str, Path] = "", size: int = 160) -> Dict[str, Any]:
    """The same as to_materialx(), as a file. "differences": of each material's linear colours by what is lost, with
    `measured` or a `picture` of balls of `size` pixels, a PNG file."""
    to, source, names = _path(output), _path(file), _names(materials)
    how_text = _text(json.dumps({"surface": surface, "measured": measured, "picture": os.fspath(picture),
                                 "size": _texels(size)}))
    return json.loads(_taken(_calling(options, messages, lambda said, how: _lib.lacquer_convert_as(
        to, source, names, len(names), how_text, how, said))))


def bake(output: Union[str, Path], file: Union[str, Path], materials: Sequence[str] = (), size: int = 512,
         options: Optional[Options] = None, messages: Optional[List[Message]] = None, **how: Any) -> Dict[str, Any]:
    """Procedural textures of a .gltf or .mtlx file as PNG files of `size` by `size` texels beside the .gltf file `output`,
    which has them; or the image alone: .png, .ktx2, .exr. `how`: `samples` along a texel's side, `nodes`, whose outputs are
    baked instead ("*" for all, and of a graph, .json), `also` ("ktx2", "exr"), `bits`, `levels`, `srgb`. "output", "images",
    and how many "textures" have one."""
    to, source, names = _path(output), _path(file), _names(materials)
    how_text = _text(json.dumps({"size": _texels(size), **how}))
    return json.loads(_taken(_calling(options, messages, lambda said, of: _lib.lacquer_bake_as(
        to, source, names, len(names), how_text, of, said))))


def _texels(size: int, most: int = 0xFFFFFFFF) -> int:
    texels = operator.index(size)
    # The library checks the range of sizes that a uint32_t holds.
    if not 0 <= texels <= 0xFFFFFFFF:
        raise ValueError(f"{size} is no size: it must be from 0 to {most}")
    return texels


def _table(function: Callable[..., int], size: int) -> NDArray[np.float32]:
    table = np.zeros((size, size, 2), dtype=np.float32)
    at = table.ctypes.data_as(ctypes.POINTER(c_float))
    _calling(None, None, lambda said, _: function(size, at, table.size, said))
    return table


def environment_dfg(size: int = 128) -> NDArray[np.float32]:
    """The table behind environment_dfg: rows of roughness, columns of N.V, pairs; from 2 to 1024."""
    return _table(_lib.lacquer_environment_dfg, size)


def environment_sheen(size: int = 128) -> NDArray[np.float32]:
    """The table behind environment_sheen."""
    return _table(_lib.lacquer_environment_sheen, size)


def filter_environment(picture: Union[bytes, str, Path], size: int = 256, samples: int = 1024, dds: bool = False,
                       shared_exponents: bool = False, name: str = "environment.hdr",
                       options: Optional[Options] = None, messages: Optional[List[Message]] = None,
                       scene: Optional[int] = None, draft: bool = False) -> Dict[str, Any]:
    """The files of `lacquer environment` in memory, from a picture of the surroundings, a file or its bytes (Radiance HDR,
    OpenEXR, a cube map in KTX2, or glTF for the environment of a scene, all in one file), which are called `name` in messages:
    what environment.json says, and as "files" the bytes by texture."""
    if not isinstance(picture, bytes):
        name = os.fspath(picture)
        picture = Path(picture).read_bytes()
    data = picture
    form = {"size": _texels(size), "samples": _texels(samples), "dds": dds, "shared_exponents": shared_exponents,
            "draft": draft}
    if scene is not None:
        form["scene"] = scene
    how_text = _text(json.dumps(form))
    at = _calling(options, messages, lambda said, how: _lib.lacquer_environment_filter(
        data, len(data), _text(name), how_text, how, said))
    try:
        made = json.loads(_sized(_lib.lacquer_environment_description, at))
        made["files"] = {}
        for slot in made["textures"]:
            count = c_size_t()
            file = _lib.lacquer_environment_file(at, _text(slot), byref(count))
            made["files"][slot] = ctypes.string_at(file, count.value)
        return made
    finally:
        _lib.lacquer_environment_free(at)


def light_profiles(files: Sequence[Union[str, Path]], output: Union[str, Path] = "", width: int = 0, height: int = 0,
                   options: Optional[Options] = None, messages: Optional[List[Message]] = None) -> Dict[str, Any]:
    """The tables of IES files, and of EXT_lights_ies in glTF files, as the layers of `output`, a .ktx2, .dds or .png file; none
    is written without. What was found, as `lacquer profile --json`; sides of 0 are those of `lacquer profile`."""
    to, sources, sides = _path(output), (c_char_p * len(files))(*map(_path, files)), (_texels(width, 2048), _texels(height, 2048))
    return json.loads(_taken(_calling(options, messages, lambda said, of: _lib.lacquer_light_profiles(
        to, sources, len(sources), *sides, of, said))))
