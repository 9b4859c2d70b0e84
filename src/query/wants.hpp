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

/// `want`. Pose and legs are there unless the list names one of them: then those that it names.
/// @param usual what is answered where nothing is named
/// @param known what this kind of robot can tell; other words are refused
Wants read_wants(Question& question, Wants usual, Wants known);

/// Says of fields that go with a word which is not wanted that they have no effect.
void refuse_without(Question& question, Wants wants, Want word, std::initializer_list<const char*> fields);

/// `samples`: points of a curve in `shape`, if that is wanted.
int read_samples(Question& question, Wants wants, int usual, int most);

}  // namespace sinew::inline v1
