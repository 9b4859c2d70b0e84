/// @file wants.hpp
/// What a question wants of its configuration, which is solved once: `want`, and what goes with its words.
#pragma once
#include <initializer_list>

#include "query/context.hpp"

namespace sinew::inline v1 {

enum class Want : unsigned {
  pose,
  legs,
  velocity,
  shape,
  stiffness,
  stability,
  margins,
  sensitivity,
  lines,
};

class Wants {
 public:
  constexpr Wants() = default;
  constexpr Wants(std::initializer_list<Want> wants) {
    for (const Want want : wants) bits_ |= bit(want);
  }
  constexpr bool has(Want want) const { return (bits_ & bit(want)) != 0; }
  constexpr Wants operator|(Wants more) const { return of(bits_ | more.bits_); }
  constexpr Wants operator&(Wants only) const { return of(bits_ & only.bits_); }
  constexpr Wants operator-(Wants less) const { return of(bits_ & ~less.bits_); }
  constexpr bool is_empty() const { return bits_ == 0; }
  constexpr bool operator==(const Wants&) const = default;

 private:
  static constexpr unsigned bit(Want want) { return 1U << static_cast<unsigned>(want); }
  static constexpr Wants of(unsigned bits) {
    Wants wants;
    wants.bits_ = bits;
    return wants;
  }

  unsigned bits_ = 0;
};

/// What a query answers by its name alone.
constexpr Wants usual_wants{Want::pose, Want::legs};

/// What a question of a kind answers where it names nothing.
constexpr Wants usual_of(Ask ask) {
  if (ask == Ask::velocity) return usual_wants | Wants{Want::velocity};
  if (ask == Ask::shape) return {Want::pose, Want::shape};
  return usual_wants;
}

/// The same of robots on rods: what senses a wrench tells no more of the rods.
constexpr Wants usual_of_rods(Ask ask) { return ask == Ask::statics ? Wants{Want::pose} : usual_of(ask); }

/// What is usual, and what a list names. Pose and legs are there unless it names one of them.
constexpr Wants wanted_of(Wants usual, Wants named) {
  return (named & usual_wants).is_empty() ? usual | named : (usual - usual_wants) | named;
}

/// `want`: what is usual, and what the list names. Pose and legs are there unless it names one of them: then
/// those that it names. Other words than the robot's mechanics can tell are refused.
Wants read_wants(Question& question);
/// The same of a question that differs from others to these robots.
Wants read_wants(Question& question, Wants usual, Wants known);

/// The words that a question's `want` names, known ones alone.
Wants named_wants(const Node& query);
/// Names one more.
void add_want(Node& query, Want want);

/// Says of fields that go with a word which is not wanted that they have no effect.
void refuse_without(Question& question, Wants wants, Want word, std::initializer_list<const char*> fields);

/// `samples`: points of a curve in `shape`, if that is wanted.
int read_samples(Question& question, Wants wants, int usual, int most);

}  // namespace sinew::inline v1
