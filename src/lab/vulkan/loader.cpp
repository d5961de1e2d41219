#ifdef LACQUER_VULKAN
#include "vulkan/loader.h"

#include <dlfcn.h>
#include <fmt/format.h>

namespace lacquer::vulkan {

static void* openLoader() { return dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL); }

bool haveLoader() { return openLoader() != nullptr; }

std::string openInstance(Instance& instance) {
  void* loader = openLoader();
  if (loader == nullptr) return "there is no Vulkan loader (libvulkan.so.1)";
  instance.find = reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(loader, "vkGetInstanceProcAddr"));
  if (instance.find == nullptr) return "the Vulkan loader has no vkGetInstanceProcAddr";
  const auto create =
      reinterpret_cast<PFN_vkCreateInstance>(instance.find(VK_NULL_HANDLE, "vkCreateInstance"));
  VkApplicationInfo application{};
  application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
  application.pApplicationName = "lacquer";
  application.apiVersion = VK_API_VERSION_1_3;
  VkInstanceCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
  info.pApplicationInfo = &application;
  const VkResult result =
      create == nullptr ? VK_ERROR_INITIALIZATION_FAILED : create(&info, nullptr, &instance.handle);
  return result == VK_SUCCESS ? ""
                              : fmt::format("the Vulkan loader found no driver (vkCreateInstance: {})",
                                            static_cast<int>(result));
}

}  // namespace lacquer::vulkan
#endif
