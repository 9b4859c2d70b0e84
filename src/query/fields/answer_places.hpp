/// @file answer_places.hpp
/// Where answers have fields, written down once: the names in the trees of answers, of which robots and
/// questions they are, and which word of `want` gives them. A test holds the table and the answers together.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "query/kinds.hpp"
#include "query/wants.hpp"
#include "sinew/io/node.hpp"
#include "sinew/robot/robot.hpp"

namespace sinew::inline v1 {

enum class AnswerPart {
  value,  ///< a number, true or false, or an array whose lengths the robot tells
  list,   ///< as long as it is
  map,
  maps,  ///< a list of them
};

struct AnswerWord;

/// The names of one level.
struct AnswerGroup {
  const AnswerWord* first = nullptr;
  std::size_t count = 0;
};

struct AnswerWord {
  std::string_view name;
  unsigned of;  ///< robots and questions, as bits
  AnswerPart part = AnswerPart::value;
  AnswerGroup below = {};         ///< of maps
  std::optional<Want> want = {};  ///< the word that it goes with
  bool is_always = false;         ///< it is there without that word, too
  std::string_view with = {};     ///< the field of the question without which it is not there
  bool is_rare = false;           ///< few answers have it
};

/// Whether a question has the field that a word goes with, and it is neither null nor false.
bool has_what_it_goes_with(const AnswerWord& word, const Node& query);

/// The answers of a robot to one kind of question.
class AnswerPlaces {
 public:
  /// @param robot by the model that is asked for
  AnswerPlaces(const Robot& robot, Ask ask);

  /// What leads to a place: its first name, and its last one.
  struct Found {
    const AnswerWord *root, *last;
    bool is_index;  ///< it ends with one
  };
  /// Nothing where no answer has such a place; the message then says what there is instead.
  tl::expected<Found, std::string> find(std::string_view place) const;

  /// What a question is answered whose `want` names these words.
  Wants wanted(Wants named) const;
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
