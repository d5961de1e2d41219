// The Vulkan functions in use, and the device that compiles.
#pragma once

#include <string>

#include "vulkan/loader.h"

namespace lacquer::cost {

// clang-format off
#define LACQUER_VULKAN_FUNCTIONS(X) \
  X(EnumeratePhysicalDevices) X(GetPhysicalDeviceProperties2) X(GetPhysicalDeviceFeatures) X(CreateDevice) \
  X(EnumerateDeviceExtensionProperties) X(CreateShaderModule) X(DestroyShaderModule) X(CreateDescriptorSetLayout) \
  X(DestroyDescriptorSetLayout) X(CreatePipelineLayout) X(DestroyPipelineLayout) X(CreateRenderPass) \
  X(DestroyRenderPass) X(CreateGraphicsPipelines) X(DestroyPipeline) X(GetPipelineExecutablePropertiesKHR) \
  X(GetPipelineExecutableStatisticsKHR) X(GetPipelineExecutableInternalRepresentationsKHR)
// clang-format on

struct Functions {
#define LACQUER_DECLARE(name) PFN_vk##name name = nullptr;
  LACQUER_VULKAN_FUNCTIONS(LACQUER_DECLARE)
#undef LACQUER_DECLARE
};

/// RADV's null device of one family, for the rest of the process. The functions belong to it.
struct Device {
  Functions vk;
  VkDevice handle = VK_NULL_HANDLE;
  std::string driver;  ///< "Mesa 22.3.6"
};

/// The path of RADV's description for the loader (radeon_icd.*.json); empty where RADV is not installed.
std::string radvManifest();

/// Opens the device; the text says what is missing, and is empty when all is well. The environment must have
/// been prepared: the loader and the driver read it here.
std::string openDevice(Device& device);

}  // namespace lacquer::cost
