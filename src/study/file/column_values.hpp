/// @file column_values.hpp
/// Values of one axis or derived value as a study file writes them: their units must agree.
#pragma once
#include <string>

#include "io/document/reader.hpp"

namespace sinew::inline v1 {

class ColumnValues {
 public:
  /// @param unit SI, of the column; found in the first value that has one where it is empty
  /// @param bare unit of bare numbers, as the file says it; may be empty
  /// @param noun what the column is, for messages: `axis`
  ColumnValues(std::string& unit, std::string bare, std::string_view noun)
      : unit_(unit),
        bare_(std::move(bare)),
        noun_(noun) {}

  /// In SI; 0 after an error. Codes: `wrong_type`, `wrong_dimension`, those of `parse_any_quantity`.
  double value(const Reader& place);

 private:
  std::string& unit_;
  std::string bare_;
  std::string_view noun_;
};

}  // namespace sinew::inline v1
