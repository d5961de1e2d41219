// What stands in the generated regions of the pages.
#pragma once

#include <string>
#include <string_view>

namespace lacquer::test {

/// The text of a region by its name, such as "layout frame". A name that there is not is a test failure.
std::string regionText(std::string_view name);

// The kinds of regions; `of` is what stands behind the first word of the name.
std::string bindingsTable();
std::string layoutTable(std::string_view of);  ///< a block's role: "frame", "lights", "object"
std::string materialTable();                   ///< of the example in README.md
std::string attributesTable();
std::string slotsTable();
std::string propertiesTable(
    std::string_view of);  ///< an object of the table of properties; "core" for glTF 2.0's
std::string extensionsTable();
std::string limitsTable();
std::string passesTable();
std::string standardNodes();                       ///< of nodes/standard/, by category
std::string linesTable();                          ///< of the parts, a section for each
std::string deviceLimitsTable();                   ///< targets::DeviceLimits, a column for each target
std::string templateOutputs(std::string_view of);  ///< a template's name

std::string glslSections(std::string_view of);  ///< terms, of the example in README.md
std::string dumpSection(std::string_view of);   ///< a pass and a term
std::string graphNode(std::string_view of);     ///< a node's id
std::string spirvLines(std::string_view of);  ///< an instruction of three floats, "Exp2", and how many lines
std::string dustyPart(std::string_view of);   ///< of the dusty example: "field", "pixel" or "light"
std::string vertexMain();
std::string sourceLines(
    std::string_view of);  ///< a file and how its first line begins, or a whole .node file

std::string optionsTable(std::string_view of);  ///< a verb, "shared" or "generation"
std::string verbsTable();
std::string takersLine();  ///< the verbs that take all options that several share

}  // namespace lacquer::test
