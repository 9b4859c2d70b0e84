/// @file reference_3pfs.hpp
/// The flexible tripods of tests/data/tripod/ (numbers of another implementation) and how far a result is
/// from them.
#pragma once

#include "reference_file.hpp"
#include "tripod_3pfs.hpp"

namespace sinew::test::shooting {

using Json = nlohmann::json;

inline const Json& data(const std::string& name) { return reference_file("data/tripod/" + name); }

inline Vector3d vector(const Json& json) {
  return {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
}

/// Largest |x − json|, NaN kept.
template <class X>
double error(const X& x, const Json& json) {
  double worst = 0;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double off = std::abs(x[i] - json[std::size_t(i)].get<double>());
    worst = std::isnan(worst) || off <= worst ? worst : off;
  }
  return worst;
}

inline Tripod tripod(const Json& set) {
  Tripod t;
  for (std::size_t i = 0; i < 6; ++i) {
    t.base[i] = vector(set["a"][i]);
    t.platform[i] = vector(set["r_i"][i]);
  }
  t.bending_stiffness = set["EI"].get<double>();
  return t;
}

inline PerRod<double> pairs(const Vector3d& L) { return {L[0], L[0], L[1], L[1], L[2], L[2]}; }

/// The set "G1" or "G2".
inline const Json& reference(const char* name) {
  for (const Json& set : data("cases.json")["sets"])
    if (set["name"] == name) return set;
  throw std::runtime_error("no such set");
}

}  // namespace sinew::test::shooting
