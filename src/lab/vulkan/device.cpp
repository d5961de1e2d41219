#include "vulkan/run.h"
#ifdef LACQUER_VULKAN
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "vulkan/device.h"
#endif

namespace lacquer::vulkan {

namespace {

Result<Device> unavailable(std::string why) {
  return lacquer::fail("vulkan-unavailable", {}, std::move(why),
                       "install the Vulkan loader and a driver (Debian: libvulkan1, mesa-vulkan-drivers), or "
                       "evaluate on the CPU with the engine float or double");
}

}  // namespace

#ifdef LACQUER_VULKAN

namespace {

/// A family that draws; UINT32_MAX when there is none.
uint32_t graphicsFamily(const RunFunctions& vk, VkPhysicalDevice physical) {
  uint32_t count = 0;
  vk.GetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vk.GetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
  for (uint32_t i = 0; i < families.size(); ++i) {
    if ((families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT) != 0) return i;
  }
  return UINT32_MAX;
}

/// Takes a physical device when it will do; false when not.
bool take(Device::State& state, VkPhysicalDevice physical) {
  VkPhysicalDeviceDriverProperties driver{};
  driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  properties.pNext = &driver;
  state.vk.GetPhysicalDeviceProperties2(physical, &properties);
  // Then RADV compiles for a GPU that is not there (docs/cost.md), and cannot run anything.
  if (driver.driverID == VK_DRIVER_ID_MESA_RADV && std::getenv("RADV_FORCE_FAMILY") != nullptr) return false;
  state.family = graphicsFamily(state.vk, physical);
  if (properties.properties.apiVersion < VK_API_VERSION_1_1 || state.family == UINT32_MAX) return false;
  state.physical = physical;
  // In the core since 1.2, though not of every device.
  VkPhysicalDeviceShaderFloat16Int8Features halves{};
  halves.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_FLOAT16_INT8_FEATURES;
  VkPhysicalDeviceFeatures2 features{};
  features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  if (properties.properties.apiVersion >= VK_API_VERSION_1_2) features.pNext = &halves;
  state.vk.GetPhysicalDeviceFeatures2(physical, &features);
  state.halves = halves.shaderFloat16 == VK_TRUE;
  state.limits = properties.properties.limits;
  state.processor = properties.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
  state.logic = features.features.logicOp == VK_TRUE;
  state.name = properties.properties.deviceName;
  state.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
  state.vk.GetPhysicalDeviceMemoryProperties(physical, &state.memory);
  VkFormatProperties format{};
  state.vk.GetPhysicalDeviceFormatProperties(physical, kFormat, &format);
  state.filters_floats =
      (format.optimalTilingFeatures & VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT) != 0;
  return true;
}

std::string makeDevice(Device::State& state) {
  const float priority = 1.0F;
  VkDeviceQueueCreateInfo queue{};
  queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue.queueFamilyIndex = state.family;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  VkDeviceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  VkPhysicalDeviceShaderFloat16Int8Features halves{};
  halves.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_FLOAT16_INT8_FEATURES;
  halves.shaderFloat16 = VK_TRUE;
  if (state.halves) info.pNext = &halves;
  VkPhysicalDeviceFeatures features{};
  features.logicOp = state.logic ? VK_TRUE : VK_FALSE;
  info.pEnabledFeatures = &features;
  const VkResult result = state.vk.CreateDevice(state.physical, &info, nullptr, &state.handle);
  if (result != VK_SUCCESS) {
    return fmt::format("{} cannot be opened (vkCreateDevice: {})", state.name, static_cast<int>(result));
  }
  state.vk.GetDeviceQueue(state.handle, state.family, 0, &state.queue);
  return {};
}

std::string openState(Device::State& state) {
  Instance instance;
  if (std::string problem = openInstance(instance); !problem.empty()) return problem;
#define LACQUER_FIND(name)                                                                    \
  state.vk.name = reinterpret_cast<PFN_vk##name>(instance.find(instance.handle, "vk" #name)); \
  if (state.vk.name == nullptr) return "the Vulkan loader does not know vk" #name;
  LACQUER_RUN_FUNCTIONS(LACQUER_FIND)
#undef LACQUER_FIND
  uint32_t count = 0;
  state.vk.EnumeratePhysicalDevices(instance.handle, &count, nullptr);
  std::vector<VkPhysicalDevice> devices(count);
  state.vk.EnumeratePhysicalDevices(instance.handle, &count, devices.data());
  devices.resize(count);
  const bool found =
      std::any_of(devices.begin(), devices.end(), [&](VkPhysicalDevice d) { return take(state, d); });
  return found ? makeDevice(state) : "no Vulkan device of this machine draws (Vulkan 1.1, a graphics queue)";
}

}  // namespace

Result<Device> Device::open() {
  const auto state = std::make_shared<State>();
  if (std::string problem = openState(*state); !problem.empty()) return unavailable(std::move(problem));
  Device device;
  device.state_ = state;
  return device;
}

const std::string& Device::name() const { return state_->name; }
const std::string& Device::driver() const { return state_->driver; }
uint32_t Device::subTexelBits() const { return state_->limits.subTexelPrecisionBits; }
uint32_t Device::mostInputs() const { return state_->mostInputs(); }
bool Device::halves() const { return state_->halves; }

#else

struct Device::State {
  std::string none;
};

Result<Device> Device::open() {
  return unavailable("this Lacquer was built without Vulkan (or not on Linux)");
}

const std::string& Device::name() const { return state_->none; }
const std::string& Device::driver() const { return state_->none; }
uint32_t Device::subTexelBits() const { return 0; }
uint32_t Device::mostInputs() const { return 0; }
bool Device::halves() const { return false; }
Result<Outcome> Device::run(const Work&) const {
  return lacquer::fail("vulkan-unavailable", {}, "there is no device");
}
Result<std::vector<double> > Device::time(const std::vector<Sweep>&, int) const {
  return lacquer::fail("vulkan-unavailable", {}, "there is no device");
}

#endif

}  // namespace lacquer::vulkan
