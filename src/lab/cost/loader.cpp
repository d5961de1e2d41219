// RADV and its null device.
#ifdef LACQUER_VULKAN
#include "cost/loader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <vector>

namespace lacquer::cost {
namespace {

std::vector<std::string> manifestFolders() {
  std::vector<std::string> folders = {"/etc/vulkan/icd.d"};
  const char* data = std::getenv("XDG_DATA_DIRS");
  std::string rest = data != nullptr && *data != '\0' ? data : "";
  rest += ":/usr/local/share:/usr/share";
  for (size_t at = 0; at <= rest.size();) {
    const size_t end = std::min(rest.find(':', at), rest.size());
    if (end > at) folders.push_back(rest.substr(at, end - at) + "/vulkan/icd.d");
    at = end + 1;
  }
  return folders;
}

std::string createDevice(Device& device, VkPhysicalDevice physical) {
  const char* const extension = VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME;
  uint32_t count = 0;
  device.vk.EnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr);
  std::vector<VkExtensionProperties> extensions(count);
  device.vk.EnumerateDeviceExtensionProperties(physical, nullptr, &count, extensions.data());
  const bool known = std::any_of(extensions.begin(), extensions.end(), [&](const VkExtensionProperties& e) {
    return std::strcmp(e.extensionName, extension) == 0;
  });
  if (!known) return fmt::format("the driver does not know {}", extension);

  VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR executable{};
  executable.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR;
  executable.pipelineExecutableInfo = VK_TRUE;
  VkPhysicalDeviceFeatures features{};
  device.vk.GetPhysicalDeviceFeatures(physical, &features);
  features.robustBufferAccess = VK_FALSE;  // it adds instructions
  const float priority = 1.0F;
  VkDeviceQueueCreateInfo queue{};
  queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  VkDeviceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  info.pNext = &executable;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = 1;
  info.ppEnabledExtensionNames = &extension;
  info.pEnabledFeatures = &features;
  const VkResult result = device.vk.CreateDevice(physical, &info, nullptr, &device.handle);
  return result == VK_SUCCESS ? "" : fmt::format("vkCreateDevice failed ({})", static_cast<int>(result));
}

}  // namespace

std::string radvManifest() {
  for (const std::string& folder : manifestFolders()) {
    std::error_code error;
    std::vector<std::string> found;
    for (std::filesystem::directory_iterator it(folder, error), end; !error && it != end;
         it.increment(error)) {
      const std::string name = it->path().filename().string();
      if (name.starts_with("radeon_icd") && name.ends_with(".json")) found.push_back(it->path().string());
    }
    // Several architectures may be installed; the loader passes over those that it cannot open.
    if (!found.empty()) {
      std::sort(found.begin(), found.end());
      std::string list = found[0];
      for (size_t i = 1; i < found.size(); ++i) list += ":" + found[i];
      return list;
    }
  }
  return {};
}

std::string openDevice(Device& device) {
  vulkan::Instance instance;
  if (std::string problem = vulkan::openInstance(instance); !problem.empty()) return problem;
#define LACQUER_FIND(name)                                                                     \
  device.vk.name = reinterpret_cast<PFN_vk##name>(instance.find(instance.handle, "vk" #name)); \
  if (device.vk.name == nullptr) return "the Vulkan loader does not know vk" #name;
  LACQUER_VULKAN_FUNCTIONS(LACQUER_FIND)
#undef LACQUER_FIND

  uint32_t count = 1;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  device.vk.EnumeratePhysicalDevices(instance.handle, &count, &physical);
  if (count == 0 || physical == VK_NULL_HANDLE) return "the driver does not know this GPU family";
  VkPhysicalDeviceDriverProperties driver{};
  driver.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES;
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  properties.pNext = &driver;
  device.vk.GetPhysicalDeviceProperties2(physical, &properties);
  // "Mesa 22.3.6-1+deb12u1": the distribution's part says nothing about the compiler.
  const std::string_view info = driver.driverInfo;
  device.driver = info.substr(0, info.find('-'));
  return createDevice(device, physical);
}

}  // namespace lacquer::cost
#endif
