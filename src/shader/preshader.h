// The preshader of a module by itself: the values of the material block's fields from those of the
// parameters, without the module. Small enough to keep for every structure, and to write to a cache.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cache/blob.h"
#include "ir/module.h"

namespace lacquer {

class Preshader {
public:
  struct Field {
    std::string name;
    ir::Type type;
    uint32_t offset;  ///< bytes in the block
    uint32_t value;   ///< step that gives it
  };

  Preshader() = default;
  /// Of a placed module.
  explicit Preshader(const ir::Module& module);

  /// In the order of the module's Preshader list.
  const std::vector<Field>& fields() const { return fields_; }

  /// The fields' values, for the parameters' values in the order of Module::parameters. A value that is not
  /// finite becomes 0; every node's contract excludes that within its ranges.
  std::vector<ir::Components> evaluate(
      const std::function<const ir::Components&(uint32_t parameter)>& value) const;

  void write(BlobWriter& blob) const;
  /// Refuses what evaluate() could not take.
  static Preshader read(BlobReader& blob);
  /// True when it asks for no parameter but the first so many.
  bool uses(size_t parameters) const;

private:
  struct Step {
    ir::Op op;
    ir::Type type;
    uint8_t count;
    uint32_t payload;  ///< Constant: into constants_; Input: the parameter; Swizzle: as in the DAG
    std::array<uint32_t, 4> args;
  };
  bool sound() const;
  bool sound(const Step& step, size_t number) const;

  std::vector<Step> steps_;
  std::vector<ir::Components> constants_;
  std::vector<Field> fields_;
};

}  // namespace lacquer
