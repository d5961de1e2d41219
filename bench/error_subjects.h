// The bodies of nodes as modules of their own: one value out, the node's parameters in.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "eval/evaluate.h"
#include "lang/library.h"

namespace lacquer::bench {

/// One input of a subject, as an attribute of the fragment.
struct SubjectInput {
  std::string name;
  int components = 1;
  double lo = 0, hi = 1;  ///< of each component
  bool unit = false;      ///< a unit vector instead
};

/// A node that has variants.
struct Subject {
  std::string node;
  std::vector<std::string> bodies;  ///< "" first, the reference
  std::vector<SubjectInput> inputs;
  std::string setup;   ///< declarations of the template that the arguments need
  std::string call;    ///< with @ in place of the node's name and variant
  std::string result;  ///< the measured value of the call's result, @ in its place
};

/// All of the library, by name.
std::vector<Subject> subjects(const lang::Library& library);

/// Inputs of `count` points, column by column. Edges of the ranges come up, too.
eval::Columns sampleInputs(const Subject& subject, size_t count, uint64_t seed);

/// The same as floats have them, so that an arithmetic is not blamed for its input.
eval::Columns roundedInputs(eval::Columns columns);

/// What a point's inputs are, for people: "F0 0.04, cosine 0.1".
std::string describeInputs(const Subject& subject, const eval::Columns& columns, size_t point);

/// Of a sample of absolute values.
struct Spread {
  double max = 0, p999 = 0, rms = 0;
  size_t at = 0;  ///< the place of the maximum
};
Spread spreadOf(std::vector<double> values);

/// Differences of two results: absolute, and in units in the last place of a float32 of the yardstick's size,
/// or of a millionth where that is more: a unit of nothing says nothing.
struct Difference {
  Spread absolute, ulp;
};
Difference differenceOf(const std::vector<double>& values, const std::vector<double>& yardstick);

/// The templates around all bodies, to be added to a library.
lang::SourceFile wrappers(const std::vector<Subject>& subjects);

/// The module around one body, as lowered. Throws std::runtime_error when the library does not hold the
/// wrappers.
ir::Module moduleOf(const lang::Library& library, const Subject& subject, const std::string& body);

/// The values of the module's outputs, component by component, in T.
template <class T>
std::vector<double> valuesOf(const ir::Module& module, const eval::Columns& columns, size_t points);

/// A fragment shader.
struct Body {
  std::vector<uint32_t> spirv;
  std::vector<std::string> inputs;  ///< that it reads, by location
};
/// Of a module around a body.
Body bodyOf(ir::Module module);
/// The same around no body: what that body reads, added up.
Body overheadOf(ir::Module module);

}  // namespace lacquer::bench
