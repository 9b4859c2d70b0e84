/// @file option_reader.hpp
/// Values of options as fields of questions have them: trees, in SI.
#pragma once
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "query/fields/fields.hpp"
#include "request.hpp"

namespace sinew::cli {

/// What commas separate, without blanks.
std::vector<std::string_view> split(std::string_view list);
Member member_of(std::string_view key, Node value);

/// Reads what options of a command line say. What cannot be read is noted, and nothing then.
class OptionReader {
 public:
  /// @param robot what spellings depend on; null: it is not known yet
  OptionReader(std::string_view query, const Arguments& arguments, const OpenRobot* robot)
      : query_(query),
        arguments_(arguments),
        robot_(robot) {}

  /// A field by its shape; growing loads and settings have several options, and are not read here.
  std::optional<Node> read(const Field& field, std::string_view option, std::string_view text);

  /// @name Shapes
  /// @{
  std::optional<Node> quantity(std::string_view option, std::string_view text, Dimension dimension);
  std::optional<Node> pose(std::string_view option, std::string_view text);
  std::optional<Node> inputs(std::string_view option, std::string_view text);
  std::optional<Node> wrench(std::string_view option, std::string_view text);
  std::optional<Node> json(std::string_view option, std::string_view text);
  std::optional<Node> pairs(std::string_view option, std::string_view text, Dimension dimension);
  /// @}

  void fail(std::string_view code, std::string_view option, std::string_view message);
  const Errors& errors() const { return errors_; }

 private:
  std::vector<double> values(std::string_view option, std::span<const std::string_view> parts,
                             std::span<const Dimension> dimensions, std::string_view per = {},
                             std::span<const std::string_view> names = {});
  std::vector<double> alike(std::string_view option, std::span<const std::string_view> parts,
                            Dimension dimension);
  std::optional<Node> independent(std::string_view option, std::string_view text);
  std::optional<Node> place(std::string_view option, std::string_view text);
  std::optional<Node> places(const std::string& file);
  std::optional<Node> start(std::string_view option, std::string_view text);
  std::optional<Node> twist(std::string_view option, std::string_view text);
  std::optional<Node> point(std::string_view option, std::string_view text, Dimension dimension);
  std::optional<Node> sections(std::string_view option, std::string_view text, Dimension dimension);
  std::optional<Node> signs(std::string_view option, std::string_view text);
  std::optional<Node> range(std::string_view option, std::string_view text);
  static Node words(std::string_view text);

  std::string_view query_;
  const Arguments& arguments_;
  const OpenRobot* robot_;
  Errors errors_;
};

}  // namespace sinew::cli
