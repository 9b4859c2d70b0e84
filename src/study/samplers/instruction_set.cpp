/// The instruction set of everything in lanes, chosen by name.
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <utility>

#include "sinew/study/sweep.hpp"

namespace sinew::inline v1 {
namespace {

/// Those the kernels are compiled for; SSSE3 is what every x86-64 of the last fifteen years has.
constexpr std::array<std::pair<std::string_view, std::uint32_t>, 3> sets{
    {{"baseline", HWY_SSSE3}, {"avx2", HWY_AVX2}, {"avx512", HWY_AVX3}}};

}  // namespace

bool use_instruction_set(std::string_view name) {
  hwy::SetSupportedTargetsForTest(0);
  hwy::GetChosenTarget().DeInit();
  if (name == "native") return true;
  const auto found = std::ranges::find(sets, name, [](const auto& set) { return set.first; });
  if (found == sets.end() || (hwy::SupportedTargets() & found->second) == 0) return false;
  hwy::SetSupportedTargetsForTest(found->second);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  return true;
}

std::string_view instruction_set_in_use() {
  const auto has = [](std::int64_t set) {
    return (static_cast<std::int64_t>(hwy::SupportedTargets()) & set) != 0;
  };
  return has(HWY_AVX3) ? "AVX-512" : has(HWY_AVX2) ? "AVX2" : "SSSE3";
}

}  // namespace sinew::inline v1
