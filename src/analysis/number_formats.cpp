#include "analysis/number_formats.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "analysis/rough_numbers.hpp"
#include "base/assert.hpp"
#include "sinew/kernel/fixed.h"
#include "sinew/kernel/section.h"

namespace sinew::inline v1 {
namespace {

struct Samples {
  std::vector<double> bends;
  std::vector<double> lengths;  ///< exact
};

/// (6) in many digits; not singular, β = 0 apart.
double exact_length(const JointTendon& tendon, double bend) {
  if (bend == 0) return tendon.length;
  using Wide = long double;
  const Wide b = Wide(bend), L = Wide(tendon.length), r = Wide(tendon.radius);
  return static_cast<double>(2 * (L / b - r) * std::sin(b / 2));
}

Samples samples_of(const JointTendon& tendon, int count) {
  Samples samples;
  for (int k = 0; k < count; ++k) {
    const double bend = tendon.range * (2 * k - (count - 1)) / (count - 1);
    samples.bends.push_back(bend);
    samples.lengths.push_back(exact_length(tendon, bend));
  }
  return samples;
}

/// @param length_of a bend
template <class Length>
LengthError error_of(const Samples& samples, const Length& length_of) {
  LengthError error;
  for (std::size_t k = 0; k < samples.bends.size(); ++k) {
    const double length = length_of(samples.bends[k]), exact = samples.lengths[k];
    const double off = std::isfinite(length) ? std::abs(length - exact) / std::abs(exact) : 1.0;
    error.mean += off;
    error.largest = std::max(error.largest, off);
  }
  error.mean /= static_cast<double>(samples.bends.size());
  return error;
}

// ---------------------------------------------------------------- in a format

template <class S>
constexpr bool is_floating = std::is_floating_point_v<S> || std::is_same_v<S, Binary16>;

/// (6) as printed, in the order in which it stands there; fixed point doubles at last, where twice the
/// bracket would overflow at twice the bend.
template <class S>
S length_by_quotient(S length, S radius, S bend) {
  if (static_cast<double>(bend) == 0) return length;
  const S sine = S(std::sin(static_cast<double>(S(bend * S(0.5)))));
  // A double holds the quotient of two short numbers well enough to round it once more.
  const S quotient = S(static_cast<double>(length) / static_cast<double>(bend));
  const S bracket = S(quotient - radius);
  if constexpr (is_floating<S>) return S(S(bracket + bracket) * sine);
  const S half = S(bracket * sine);
  return half + half;
}

/// One joint of a neutral backbone is a section; its tendon stands in the plane of the bend.
template <kernel::Model model, class S>
S length_by_kernel(const kernel::Section<S>& joint, S bend) {
  const kernel::Direction<S> ahead{S(1.0), S(0.0)};
  const kernel::Bend<S> in_plane{bend, S(0.0)};
  return joint.length + kernel::tendon_change(kernel::pull<model>(joint, in_plane), ahead);
}

template <class S>
LengthErrors errors_in(const JointTendon& tendon, const Samples& samples) {
  const auto joint = kernel::make_section<S>(kernel::Backbone::neutral, 1, tendon.length, tendon.radius);
  const S length = S(tendon.length), radius = S(tendon.radius);
  return {error_of(samples,
                   [&](double bend) {
                     return static_cast<double>(length_by_quotient<S>(length, radius, S(bend)));
                   }),
          error_of(samples,
                   [&](double bend) {
                     return static_cast<double>(length_by_kernel<kernel::Model::linear>(joint, S(bend)));
                   }),
          error_of(samples, [&](double bend) {
            return static_cast<double>(length_by_kernel<kernel::Model::exact>(joint, S(bend)));
          })};
}

template <class S>
LengthError error_of_inputs(const JointTendon& tendon, const Samples& samples) {
  const auto rounded = [](double value) { return static_cast<double>(S(value)); };
  const JointTendon held{rounded(tendon.length), rounded(tendon.radius), tendon.range};
  return error_of(samples, [&](double bend) { return exact_length(held, rounded(bend)); });
}

template <class S>
FormatErrors floating(const char* name, int bits, const JointTendon& tendon, const Samples& samples) {
  return {name, bits, {}, errors_in<S>(tendon, samples), error_of_inputs<S>(tendon, samples), {}};
}

template <int Bits, int Fraction>
FormatErrors fixed(const char* name, const JointTendon& tendon, const Samples& samples) {
  constexpr int before = Bits - 1 - Fraction;
  using S = kernel::Fixed<Bits, Fraction>;
  FormatErrors errors{name, Bits, before, errors_in<S>(tendon, samples), error_of_inputs<S>(tendon, samples),
                      {}};
  errors.coded = {errors_in<CodedFixed<Bits, Fraction, Rounding::down, Overflow::saturate>>(tendon, samples),
                  errors_in<CodedFixed<Bits, Fraction, Rounding::nearest, Overflow::wrap>>(tendon, samples),
                  errors_in<CodedFixed<Bits, Fraction, Rounding::down, Overflow::wrap>>(tendon, samples),
                  std::ldexp(tendon.length, -before)};
  return errors;
}

}  // namespace

std::vector<FormatErrors> format_errors(const JointTendon& tendon, int samples) {
  SINEW_EXPECTS(samples >= 2 && tendon.range > 0);
  const Samples all = samples_of(tendon, samples);
  return {floating<double>("double", 64, tendon, all),
          floating<float>("float", 32, tendon, all),
          floating<Binary16>("binary16", 16, tendon, all),
          fixed<32, 16>("Q15.16", tendon, all),
          fixed<32, 24>("Q7.24", tendon, all),
          fixed<32, 28>("Q3.28", tendon, all),
          fixed<16, 8>("Q7.8", tendon, all),
          fixed<16, 10>("Q5.10", tendon, all),
          fixed<16, 11>("Q4.11", tendon, all),
          fixed<16, 12>("Q3.12", tendon, all),
          fixed<16, 13>("Q2.13", tendon, all),
          fixed<8, 4>("Q3.4", tendon, all),
          fixed<8, 5>("Q2.5", tendon, all)};
}

}  // namespace sinew::inline v1
