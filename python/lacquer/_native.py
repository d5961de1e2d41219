"""The shared library and its functions, as lacquer_c.h declares them."""

from __future__ import annotations

import ctypes
import ctypes.util
import os
from ctypes import POINTER, c_char_p, c_double, c_float, c_int, c_size_t, c_ssize_t, c_uint8, c_uint32, c_void_p
from pathlib import Path
from typing import List

INTERFACE_VERSION = 1


class Value(ctypes.Structure):
    """lacquer_value."""

    _fields_ = [("name", c_char_p), ("numbers", POINTER(c_double)), ("count", c_size_t)]


class Array(ctypes.Structure):
    """lacquer_array."""

    _fields_ = [("name", c_char_p), ("numbers", c_void_p), ("is_double", c_int), ("components", c_size_t),
                ("stride", c_ssize_t)]


class Colors(ctypes.Structure):
    """lacquer_colors."""

    _fields_ = [("rgba", c_void_p), ("is_double", c_int), ("stride", c_ssize_t), ("discarded", c_void_p)]


# A row for each function that this package calls: what it returns, then what it takes.
_SIZE = POINTER(c_size_t)
_FUNCTIONS = {
    "c_version": (c_uint32,),
    "version": (c_char_p,),
    "text_data": (c_void_p, c_void_p),
    "text_size": (c_size_t, c_void_p),
    "text_free": (None, c_void_p),
    "messages_new": (c_void_p,),
    "messages_free": (None, c_void_p),
    "messages_count": (c_size_t, c_void_p),
    "message_level": (c_int, c_void_p, c_size_t),
    "message_part": (c_void_p, c_void_p, c_size_t, c_int, _SIZE),
    "message_line": (c_uint32, c_void_p, c_size_t),
    "message_column": (c_uint32, c_void_p, c_size_t),
    "options_new": (c_void_p, c_char_p, c_size_t, c_void_p),
    "options_free": (None, c_void_p),
    "scene_load": (c_void_p, c_char_p, c_void_p, c_void_p),
    "scene_read": (c_void_p, c_char_p, c_size_t, c_char_p, c_void_p, c_void_p),
    "scene_free": (None, c_void_p),
    "scene_material_count": (c_size_t, c_void_p),
    "scene_material_name": (c_void_p, c_void_p, c_size_t, _SIZE),
    "scene_find_material": (c_size_t, c_void_p, c_char_p, c_void_p),
    "scene_use_count": (c_size_t, c_void_p, c_size_t),
    "scene_use": (c_uint32, c_void_p, c_size_t, c_size_t),
    "scene_graph": (c_void_p, c_void_p, c_size_t, c_uint32, c_void_p, c_void_p),
    "scene_evaluate": (c_void_p, c_void_p, c_size_t, c_char_p, c_size_t, c_int, c_void_p, c_void_p),
    "scene_colors_of": (c_int, c_void_p, c_size_t, POINTER(Array), c_size_t, c_size_t, c_int, POINTER(Colors), c_void_p,
                        c_void_p),
    "graph_colors_of": (c_int, c_void_p, POINTER(Array), c_size_t, c_size_t, c_int, POINTER(Colors), c_void_p, c_void_p),
    "scene_preview": (c_int, c_void_p, c_size_t, c_uint32, POINTER(c_uint8), c_size_t, c_void_p, c_void_p),
    "scene_properties": (c_void_p, c_void_p, c_size_t, c_uint32, c_void_p, c_void_p),
    "graph_read_with": (c_void_p, c_char_p, c_size_t, c_char_p, c_void_p, c_void_p),
    "graph_free": (None, c_void_p),
    "graph_json": (c_void_p, c_void_p),
    "graph_dot": (c_void_p, c_void_p),
    "graph_parameters": (c_void_p, c_void_p),
    "check_nodes": (c_int, c_void_p, c_void_p),
    "materialx": (c_void_p, c_char_p, POINTER(c_char_p), c_size_t, c_char_p, c_void_p, c_void_p),
    "convert": (c_int, c_char_p, c_char_p, POINTER(c_char_p), c_size_t, c_char_p, c_void_p, c_void_p),
    "bake": (c_void_p, c_char_p, c_char_p, POINTER(c_char_p), c_size_t, c_uint32, c_void_p, c_void_p),
    "bake_as": (c_void_p, c_char_p, c_char_p, POINTER(c_char_p), c_size_t, c_char_p, c_void_p, c_void_p),
    "convert_as": (c_void_p, c_char_p, c_char_p, POINTER(c_char_p), c_size_t, c_char_p, c_void_p, c_void_p),
    "gltf": (c_void_p, c_char_p, POINTER(c_char_p), c_size_t, c_uint32, c_void_p, c_void_p),
    "scene_materialx": (c_void_p, c_void_p, POINTER(c_char_p), c_size_t, c_char_p, POINTER(c_size_t), POINTER(c_void_p),
                        c_size_t, c_void_p, c_void_p),
    "scene_gltf": (c_void_p, c_void_p, POINTER(c_char_p), c_size_t, c_uint32, c_void_p, c_void_p),
    "graph_textures": (c_void_p, c_void_p),
    "graph_groups": (c_void_p, c_void_p),
    "graph_nodes": (c_void_p, c_void_p, c_char_p),
    "graph_outputs": (c_void_p, c_void_p, c_char_p),
    "graph_sockets": (c_void_p, c_void_p, c_char_p, c_void_p),
    "graph_add_node": (c_int, c_void_p, c_char_p, c_char_p, c_void_p),
    "graph_remove_node": (c_int, c_void_p, c_char_p, c_void_p),
    "graph_connect": (c_int, c_void_p, c_char_p, c_char_p, c_char_p, c_void_p),
    "graph_set_output": (c_int, c_void_p, c_char_p, c_char_p, c_void_p),
    "graph_add_instance": (c_int, c_void_p, c_char_p, c_char_p, c_void_p),
    "graph_rename_node": (c_int, c_void_p, c_char_p, c_char_p, c_void_p),
    "graph_disconnect": (c_int, c_void_p, c_char_p, c_char_p, c_void_p),
    "graph_remove_output": (c_int, c_void_p, c_char_p, c_void_p),
    "graph_make_group": (c_int, c_void_p, POINTER(c_char_p), c_size_t, c_char_p, c_char_p, c_void_p),
    "graph_add_group": (c_int, c_void_p, c_char_p, c_void_p, c_void_p),
    "graph_expand": (c_int, c_void_p, c_char_p, c_void_p),
    "graph_edit": (c_void_p, c_void_p, c_char_p, c_size_t, c_void_p),
    "graph_changes": (c_int, c_void_p),
    "graph_set_parameter": (c_int, c_void_p, c_char_p, POINTER(c_double), c_size_t, c_void_p),
    "graph_set_range": (c_int, c_void_p, c_char_p, c_double, c_double, c_int, c_void_p),
    "graph_check": (c_int, c_void_p, c_void_p, c_void_p),
    "graph_evaluate": (c_void_p, c_void_p, c_char_p, c_size_t, c_int, c_void_p, c_void_p),
    "graph_preview": (c_int, c_void_p, c_uint32, POINTER(c_uint8), c_size_t, c_void_p, c_void_p),
    "graph_generate": (c_void_p, c_void_p, c_void_p, c_void_p),
    "graph_dump": (c_void_p, c_void_p, c_char_p, c_void_p, c_void_p),
    "shader_free": (None, c_void_p),
    "shader_id": (c_char_p, c_void_p),
    "shader_has_vertex_stage": (c_int, c_void_p),
    "shader_text": (c_void_p, c_void_p, c_char_p, c_int, _SIZE),
    "shader_spirv": (c_void_p, c_void_p, c_int, _SIZE),
    "shader_interface": (c_void_p, c_void_p, _SIZE),
    "shader_uniform_size": (c_size_t, c_void_p),
    "shader_pack": (c_int, c_void_p, POINTER(Value), c_size_t, c_void_p, c_size_t, c_void_p),
    "shader_pack_graph": (c_int, c_void_p, c_void_p, c_void_p, c_size_t, c_void_p),
    "nodes": (c_void_p, c_void_p, c_void_p),
    "light_profiles": (c_void_p, c_char_p, POINTER(c_char_p), c_size_t, c_uint32, c_uint32, c_void_p, c_void_p),
    "environment_dfg": (c_int, c_uint32, POINTER(c_float), c_size_t, c_void_p),
    "environment_sheen": (c_int, c_uint32, POINTER(c_float), c_size_t, c_void_p),
    "environment_filter": (c_void_p, c_char_p, c_size_t, c_char_p, c_char_p, c_void_p, c_void_p),
    "environment_free": (None, c_void_p),
    "environment_description": (c_void_p, c_void_p, _SIZE),
    "environment_file": (c_void_p, c_void_p, c_char_p, _SIZE),
}


def _candidates() -> List[str]:
    """LACQUER_LIBRARY, the library of a wheel that has one, of a build of this tree, that of the installation around, what the
    system has."""
    named = os.environ.get("LACQUER_LIBRARY")
    if named:
        return [named]
    within = Path(__file__).resolve().parent / "lib" / "liblacquer.so"
    if within.exists():
        return [str(within)]
    built = Path(__file__).resolve().parents[2] / "build" / "release" / "liblacquer.so"
    found = [str(built)] if built.exists() else []
    # An installation has the package in share/lacquer/python.
    for above in list(Path(__file__).resolve().parents)[4:5]:
        found += [str(one) for one in sorted(above.glob("lib*/liblacquer.so")) + sorted(above.glob("lib/*/liblacquer.so"))]
    system = ctypes.util.find_library("lacquer")
    return found + ([system] if system else []) + ["liblacquer.so", "liblacquer.so.0.2"]


def load() -> ctypes.CDLL:
    """The library with the types of its functions."""
    tried = []
    for path in _candidates():
        try:
            library = ctypes.CDLL(path)
        except OSError as error:
            tried.append(str(error))
            continue
        for name, (result, *arguments) in _FUNCTIONS.items():
            function = getattr(library, "lacquer_" + name)
            function.restype = result
            function.argtypes = arguments
        version = library.lacquer_c_version()
        if version != INTERFACE_VERSION:
            raise ImportError(f"{path} has the interface {version}, not {INTERFACE_VERSION}")
        return library
    raise ImportError("Lacquer's shared library is not there; LACQUER_LIBRARY names it: " + "; ".join(tried))
