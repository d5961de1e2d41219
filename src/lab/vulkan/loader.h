// The Vulkan loader, opened at run time: a machine without Vulkan runs everything else.
#pragma once

#define VK_NO_PROTOTYPES
#include <vulkan/vulkan.h>

#include <string>

namespace lacquer::vulkan {

/// An instance of Vulkan 1.1 or later and the way to its functions. Neither is ever closed: drivers leave
/// threads and exit handlers behind.
struct Instance {
  PFN_vkGetInstanceProcAddr find = nullptr;
  VkInstance handle = VK_NULL_HANDLE;
};

/// True when the Vulkan loader can be opened.
bool haveLoader();

/// The text says what is missing, and is empty when all is well. Loader and drivers read the environment
/// here.
std::string openInstance(Instance& instance);

}  // namespace lacquer::vulkan
