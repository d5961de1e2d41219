// What engines on WebGPU and Metal need to know of a shader beside the rest of its manifest entry: where WGSL
// and MSL bind what the contract has at a set and a binding.
#pragma once

#include "ir/module.h"
#include "json/json.h"

namespace lacquer {

/// "bindings": what createBindGroupLayout() wants, in its words, with the group of each; "limits": what
/// requestDevice() must be asked for beyond WebGPU's defaults, with colour attachments of `rgba16float`,
/// empty where nothing is. The module must be placed and bound.
json::Json webgpuOf(const ir::Module& module);

/// "entry", the function's name; "argument_buffers"; and "bindings": the stages that read it, and the
/// `buffer`, or the `texture` and the `sampler`, of each block and texture; in argument buffers the
/// `argument_buffer` and the `id`, of a texture the `sampler_id`, too.
json::Json metalOf(const ir::Module& module, bool argument_buffers);

}  // namespace lacquer
