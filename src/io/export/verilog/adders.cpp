#include "io/export/verilog/adders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace sinew::inline v1::verilog {
namespace {

/// A number of the tree.
struct Term {
  std::string name;
  int bits = 0;

  std::string widened(int to) const {
    if (bits >= to) return name;
    return fmt::format("$signed({{{{{}{{{}[{}]}}}}, {}}})", to - bits, name, bits - 1, name);
  }
};

/// The register of a sum, or of a term that waits.
Term add(const Term& a, const Term* b, std::string name, std::string& text) {
  const int most = b ? std::max(a.bits, b->bits) : a.bits;
  const Term sum{std::move(name), b ? std::min(32, most + 1) : most};
  const std::string value = b ? a.widened(most) + " + " + b->widened(most) : a.name;
  text += fmt::format("  reg signed [{0}:0] {1};\n  always @(posedge clock) {1} <= {2};\n", sum.bits - 1,
                      sum.name, value);
  return sum;
}

}  // namespace

std::string adders(const std::vector<int>& factor_bits, int levels) {
  std::string text;
  std::vector<Term> terms;
  for (std::size_t i = 0; i < factor_bits.size(); ++i) {
    terms.push_back({fmt::format("product_{}", i), factor_bits[i] + 16});
    text += fmt::format("  wire signed [{}:0] {} = products[{} +: {}];\n", terms[i].bits - 1, terms[i].name,
                        32 * i, terms[i].bits);
  }
  for (int level = 1; level <= levels; ++level) {
    std::vector<Term> sums;
    for (std::size_t i = 0; i < terms.size(); i += 2)
      sums.push_back(add(terms[i], i + 1 < terms.size() ? &terms[i + 1] : nullptr,
                         fmt::format("sum_{}_{}", level, i / 2), text));
    terms = std::move(sums);
  }
  return text + fmt::format("  assign sum = {};", terms[0].widened(32));
}

}  // namespace sinew::inline v1::verilog
