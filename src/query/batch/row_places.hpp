/// @file row_places.hpp
/// A question of many rows as it is read once, and where in it the numbers of their columns go.
#pragma once
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "query/batch/sampler.hpp"
#include "sinew/units.hpp"

namespace sinew::inline v1 {

/// A number that is the same in all rows, or a column's.
struct RowNumber {
  double value = 0;
  std::ptrdiff_t input = -1;  ///< −1: `value`
  Range range = {};           ///< with which a reader reads it

  double at(const SampleBlock& block, std::size_t k) const {
    return input < 0 ? value : block.input(static_cast<std::size_t>(input), k);
  }
  /// Whether a question would take a row's number: finite, and in its range.
  bool is_taken(double number) const { return std::isfinite(number) && range.contains(number); }
};

class RowPlaces {
 public:
  /// @param question must outlive it
  explicit RowPlaces(const BatchQuestion& question);

  /// The question with some number wherever one of a column goes.
  const Document& trial() const { return trial_; }
  const std::vector<std::string>& outputs() const { return question_->outputs; }
  bool is_path() const { return question_->is_path; }

  /// Whether all columns go to these places, or into lists and maps there.
  bool are_within(std::initializer_list<std::string_view> places) const;
  bool is_column(std::string_view place) const { return input_at(place) >= 0; }
  /// What goes to a place, such as `wrench[2]`, of which this was read of the trial.
  RowNumber number(std::string_view place, double read, Range range = {}) const {
    return {read, input_at(place), range};
  }
  /// The same of a list.
  std::vector<RowNumber> numbers(std::string_view place, std::span<const double> read,
                                 Range range = {}) const;

 private:
  std::ptrdiff_t input_at(std::string_view place) const;

  const BatchQuestion* question_;
  Document trial_;
  std::vector<std::pair<std::string, std::size_t>> columns_;  ///< places, and which inputs go there
  bool has_unknown_ = false;                                  ///< names of no input
};

/// Of a sampler that is made of what a question asks, which all threads share.
template <class Made, class Asked>
SamplerKind sampler_kind(std::string_view name, decltype(SamplerKind::chunks) chunks, Asked asked) {
  const auto shared = std::make_shared<const Asked>(std::move(asked));
  return {.name = name, .chunks = chunks, .make = [shared]() -> Sampler {
            return
                [sampler = std::make_shared<Made>(shared)](const SampleBlock& block) { (*sampler)(block); };
          }};
}

bool is_name(const Node& node);  ///< a text `$name`, where a column's number goes
/// Some number for each of them, whose text stays, for messages.
void put_some_numbers(Node& node);
/// The places of those of a question, single numbers all.
std::vector<std::string> places_of_names(const Node& query);
/// Whether a place is one of these, or a list or map around one.
bool is_at_or_around(std::string_view place, std::span<const std::string> places);

}  // namespace sinew::inline v1
