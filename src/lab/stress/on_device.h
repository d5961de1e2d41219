// What `lacquer stress` attacks, on a Vulkan device.
#pragma once

#include <memory>
#include <string>

#include "eval/gpu.h"
#include "stress/device.h"

namespace lacquer {

/// A subject's samples on a device, which must outlive the answer, as the subject must. Where the device
/// cannot show it `skipped` says why, and there is no answer: a node whose samples are each other's
/// neighbours, or that takes matrices or other textures than planes and cubes.
struct DeviceSubject {
  stress::Shower show;
  std::string skipped;
};
DeviceSubject deviceSubject(const stress::Subject& subject, const vulkan::Device& device,
                            FragmentRoute route);

}  // namespace lacquer
