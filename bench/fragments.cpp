#include "bench/fragments.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "support/file.h"
#include "vulkan/run.h"

namespace lacquer::bench {

namespace {

using nlohmann::json;

/// Of a texture's side: large enough that a filter has neighbours.
constexpr uint32_t kTexels = 4;

std::string contentOf(const std::string& file) {
  Result<std::string> bytes = readFile(file);
  if (!bytes) throw std::runtime_error(bytes.error()[0].message);
  return std::move(*bytes);
}

vulkan::BindingPlace placeOf(const json& of) {
  return {of.at("set").get<uint32_t>(), of.at("binding").get<uint32_t>()};
}

vulkan::Shape shapeOf(const std::string& name) {
  if (name == "plane") return vulkan::Shape::Plane;
  if (name == "cube") return vulkan::Shape::Cube;
  if (name == "array") return vulkan::Shape::Array;
  if (name == "volume") return vulkan::Shape::Volume;
  throw std::runtime_error(fmt::format("there is no shape \"{}\"", name));
}

vulkan::Texture textureOf(const json& of) {
  vulkan::Texture texture;
  texture.image = texture.sampler = placeOf(of);
  texture.shape = shapeOf(of.at("shape").get<std::string>());
  const bool one = texture.shape == vulkan::Shape::Cube;
  texture.width = texture.height = one ? 1 : kTexels;
  texture.texels = std::make_shared<std::vector<vulkan::Texel>>(size_t{texture.width} * texture.height,
                                                                vulkan::Texel{0.5F, 0.5F, 0.5F, 1});
  return texture;
}

vulkan::Sweep sweepOf(const json& of) {
  vulkan::Sweep sweep;
  const std::string bytes = contentOf(of.at("file").get<std::string>());
  sweep.fragment.resize(bytes.size() / sizeof(uint32_t));
  std::memcpy(sweep.fragment.data(), bytes.data(), sweep.fragment.size() * sizeof(uint32_t));
  for (const json& input : of.at("inputs")) {
    sweep.inputs.push_back(
        {input.at("components").get<uint32_t>(), input.at("values").get<std::vector<float>>()});
  }
  for (const json& block : of.at("blocks"))
    sweep.blocks.push_back({placeOf(block), false, block.at("bytes").get<std::vector<unsigned char>>()});
  for (const json& texture : of.at("textures")) sweep.textures.push_back(textureOf(texture));
  return sweep;
}

}  // namespace

int printFragmentTimes(const std::string& file) {
  const json asked = json::parse(contentOf(file));
  std::vector<vulkan::Sweep> sweeps;
  for (const json& sweep : asked.at("sweeps")) sweeps.push_back(sweepOf(sweep));
  const Result<vulkan::Device> device = vulkan::Device::open();
  if (!device) throw std::runtime_error(device.error()[0].message);
  const Result<std::vector<double>> times = device->time(sweeps, asked.at("rounds").get<int>());
  if (!times) throw std::runtime_error(times.error()[0].message);
  fmt::print("{}\n", json{{"device", device->name()}, {"nanoseconds", *times}}.dump());
  return 0;
}

}  // namespace lacquer::bench
