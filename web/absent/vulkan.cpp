// In place of src/lab/vulkan/ and of lab/eval/gpu.cpp: this build has no devices.
#include "eval/gpu.h"
#include "vulkan/run.h"

namespace lacquer {

static tl::unexpected<Diagnostics> absent() {
  return fail("vulkan-unavailable", {}, "this build of Lacquer has no Vulkan",
              "the engines are double and float");
}

Result<std::vector<uint32_t>> fragmentWords(const ir::Module&, FragmentRoute) { return absent(); }
vulkan::Texture textureFor(ir::Type) { return {}; }
Result<vulkan::Work> gpuWork(const ir::Module&, const eval::Bindings&, const GpuTextures&, size_t,
                             FragmentRoute) {
  return absent();
}

namespace vulkan {

Result<Device> Device::open() { return absent(); }
const std::string& Device::name() const {
  static const std::string kNone;
  return kNone;
}
Result<Outcome> Device::run(const Work&) const { return absent(); }

}  // namespace vulkan

}  // namespace lacquer
