// Where readers put what they find wrong.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "json/json.h"
#include "json/path.h"
#include "support/diagnostic.h"

namespace lacquer::json {

/// Adds diagnostics of one file to a list, as many as addBounded() takes.
class Report {
public:
  Report(const std::string& file, Diagnostics& out) : file_(file), out_(out) {}

  void error(std::string_view code, const Path& path, std::string message, std::string help = {});
  void warning(std::string_view code, const Path& path, std::string message, std::string help = {});
  void note(std::string_view code, const Path& path, std::string message, std::string help = {});

  /// "NAME is a string", "it must be EXPECTED" [wrong-type].
  void wrongType(const Path& path, std::string_view name, const Json& value, std::string_view expected);

  /// The value of a number without a fractional part. Else a wrong-type error about `name`, and nothing.
  std::optional<double> wholeNumber(const Path& path, std::string_view name, const Json& value,
                                    std::string_view expected);

  /// Reads an index below `count` into `out`. Else an error about `name`, and false. `noun` is what is
  /// indexed.
  bool index(const Path& path, std::string_view name, const Json& value, size_t count, std::string_view noun,
             int& out);

private:
  void add(Severity severity, std::string_view code, const Path& path, std::string message, std::string help);

  const std::string& file_;
  Diagnostics& out_;
};

}  // namespace lacquer::json
