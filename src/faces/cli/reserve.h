// Memory set aside for code that cannot say that there is none.
#pragma once

namespace lacquer::cli {

/// As long as it lives, an allocation that fails is tried once more with what was set aside. CLI11 allocates
/// in functions that may not throw, so that without this a failure there would end the program by abort. One
/// at a time.
class Reserve {
public:
  Reserve();
  ~Reserve();
  Reserve(const Reserve&) = delete;
  Reserve& operator=(const Reserve&) = delete;
};

}  // namespace lacquer::cli
