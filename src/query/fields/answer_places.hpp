/// @file answer_places.hpp
/// The places of answers of a robot to a kind of question, looked up in the table of fields.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "query/fields/answer_fields.hpp"
#include "sinew/io/node.hpp"
#include "sinew/robot/robot.hpp"

namespace sinew::inline v1 {

/// Whether a question has the field that a word goes with, and it is neither null nor false.
bool has_what_it_goes_with(const AnswerWord& word, const Node& query);

/// The answers of a robot to one kind of question.
class AnswerPlaces {
 public:
  /// @param robot by the model that is asked for
  AnswerPlaces(const Robot& robot, Ask ask);
  /// Those of all robots together: enough for units, which a name has whoever answers.
  explicit AnswerPlaces(Ask ask);

  /// What leads to a place: its first name, and its last one.
  struct Found {
    const AnswerWord *root, *last;
  };
  /// Nothing where no answer has such a place; the message then says what there is instead.
  tl::expected<Found, std::string> find(std::string_view place) const;

  /// What stands there, in a list or by itself, even where the question wants it not; null of maps and where
  /// nothing is known of it.
  const AnswerField* field(std::string_view place) const;
  /// The SI unit of a number there, as far as its place tells; empty for plain numbers, and where numbers of
  /// its field have several.
  std::string_view unit(std::string_view place) const;

  /// What a question is answered whose `want` names these words.
  Wants wanted(Wants named) const;
  /// Whether what stands there is told to such a question.
  bool is_told(std::string_view place, Wants named) const;
  /// Places of the values that a word of `want` gives by itself to a question.
  std::vector<std::string> given_by(Want want, const Node& query) const;

 private:
  std::vector<const AnswerWord*> words(AnswerGroup group, std::ptrdiff_t leg = -1) const;
  std::string no_such(std::string_view place, std::string_view before, AnswerGroup group,
                      std::ptrdiff_t leg) const;

  bool is_given(const AnswerWord& word) const;

  unsigned bits_;
  std::vector<unsigned> legs_;  ///< of each leg its own bits
  Ask ask_;
};

}  // namespace sinew::inline v1
