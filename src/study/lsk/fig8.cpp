/// LSK Fig. 8: cycles of the kernels against the number of sections on the paper's ATmega2560, measured in a
/// simulator that counts as the part does. The paper prints no number in it; its claims are compared.
/// Theory: docs/theory/controller.md
#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cmath>

#include "base/limits.hpp"
#include "study/compare.hpp"
#include "study/item.hpp"
#include "study/lsk/cycles/measure.hpp"
#include "study/lsk/example.hpp"

namespace sinew::inline v1 {
namespace {

namespace fs = std::filesystem;
using lsk::CyclesRun;
using lsk::KernelCycles;

constexpr int max_sections = 10, prototype = 5;
constexpr double megahertz = 16;

using Runs = std::vector<CyclesRun>;  ///< of 1 to 10 sections

const KernelCycles& at(const Runs& runs, int sections, std::string_view kernel) {
  return *runs[static_cast<std::size_t>(sections - 1)].find(kernel);
}

Expected<Runs> measure_all(const lsk::CyclesTools& tools, const fs::path& folder) {
  std::vector<Expected<CyclesRun>> parts(max_sections, CyclesRun{});
  tbb::parallel_for(0, max_sections, [&](int k) {  // the longest first
    const int sections = max_sections - k;
    parts[static_cast<std::size_t>(sections - 1)] = lsk::measure_cycles(sections, tools, folder);
  });
  Runs runs;
  for (Expected<CyclesRun>& part : parts) {
    if (!part) return tl::unexpected(part.error());
    runs.push_back(std::move(*part));
  }
  return runs;
}

Table table_of(const Runs& runs, const lsk::CyclesTools& tools) {
  Table table{"sections", "kernel", "mean[cycles]", "least[cycles]", "most[cycles]", "mean[us]", "error[mm]"};
  table.comments = lsk::provenance("lsk/fig8", "cycles of the kernels on an ATmega2560, 16 MHz");
  table.comments.push_back("compiler: " + tools.compiler_version);
  for (std::size_t k = 0; k < runs[0].kernels.size(); ++k)
    table.comments.push_back(fmt::format("kernel {}: {}", k, runs[0].kernels[k].kernel));
  for (const CyclesRun& run : runs)
    for (std::size_t k = 0; k < run.kernels.size(); ++k) {
      const KernelCycles& kernel = run.kernels[k];
      table.add_row({double(run.sections), double(k), kernel.mean, double(kernel.least), double(kernel.most),
                     kernel.mean / megahertz, kernel.error});
    }
  return table;
}

/// Exponent of growth between two numbers of sections.
double growth(const Runs& runs, std::string_view kernel, int from, int to) {
  return std::log(at(runs, to, kernel).mean / at(runs, from, kernel).mean) / std::log(double(to) / from);
}

/// How far the means lie from the line through the first and the last, as a share of the last.
double off_a_line(const Runs& runs, std::string_view kernel, bool of_most) {
  const auto value = [&](int sections) {
    const KernelCycles& k = at(runs, sections, kernel);
    return of_most ? double(k.most) : k.mean;
  };
  const double first = value(1), last = value(max_sections);
  double off = 0;
  for (int m = 1; m <= max_sections; ++m)
    off = std::max(off, std::abs(value(m) - first - (last - first) * (m - 1) / (max_sections - 1)) / last);
  return off;
}

Finding quadratic(const Runs& runs) {
  constexpr const char* kernel = "pcc_polar_paper_float";
  // a line and a square through 1, 5 and 10 sections: evaluations are 3/2 (M² + M)
  const double one = at(runs, 1, kernel).mean, ten = at(runs, max_sections, kernel).mean,
               five = at(runs, prototype, kernel).mean;
  const double ratio = (ten - one) / (five - one), evaluations = (165.0 - 3) / (45.0 - 3);
  return compare::claimed("PCC as the paper codes it grows with the square of the sections", "quadratic",
                          fmt::format("{:.0f} to {:.0f} cycles, exponent {:.2f} from 5 to 10", one, ten,
                                      growth(runs, kernel, prototype, max_sections)),
                          std::abs(ratio / evaluations - 1), 0.05, "of its evaluations, 3/2 (M² + M)");
}

Finding peaks(const Runs& runs) {
  constexpr const char* kernel = "pcc_polar_paper_float";
  const double exponent =
      std::log(double(at(runs, 10, kernel).most) / double(at(runs, 5, kernel).most)) / std::log(2.0);
  const double mean = growth(runs, kernel, prototype, max_sections);
  return {"its peaks grow exponentially", "claimed",
          fmt::format("the largest time grows with exponent {:.2f} from 5 to 10, the mean with {:.2f}",
                      exponent, mean),
          "", exponent < 2 ? "fails" : "holds"};
}

Finding linear(const Runs& runs, std::string_view kernel, const char* name) {
  return compare::claimed(
      fmt::format("{} grows linearly, in the mean and at most", name), "linear",
      fmt::format("{:.0f} cycles a section", (at(runs, 10, kernel).mean - at(runs, 1, kernel).mean) / 9),
      std::max(off_a_line(runs, kernel, false), off_a_line(runs, kernel, true)), 0.02,
      "of the cycles of 10 sections");
}

Finding faster(const Runs& runs) {
  const auto ratio = [&](int m) {
    return at(runs, m, "pcc_polar_paper_float").mean / at(runs, m, "lsk_polar_float").mean;
  };
  return {"LSK is M times as fast as PCC as the paper codes it", "M",
          fmt::format("{:.2f} of 1 section, {:.1f} of 5, {:.1f} of 10; evaluations alone give (M + 1)/2",
                      ratio(1), ratio(5), ratio(10)),
          "", std::abs(ratio(5) / 5 - 1) < 0.1 && std::abs(ratio(10) / 10 - 1) < 0.1 ? "agrees" : "differs"};
}

Finding of_kernel(const Runs& runs, std::string_view kernel, const char* name) {
  const KernelCycles& k = at(runs, prototype, kernel);
  return {fmt::format("5 sections: {}", name), "drawn, not printed",
          fmt::format("{:.0f} cycles [{} to {}], {:.0f} µs, off by {:.2g} mm", k.mean, k.least, k.most,
                      k.mean / megahertz, k.error),
          "", "for information"};
}

struct Named {
  const char *kernel, *name;
};
constexpr std::array named{
    Named{"pcc_polar_paper_float", "PCC (1) as the paper codes it, float"},
    Named{"pcc_twin_paper_float", "PCC (2) as the paper codes it, float"},
    Named{"pcc_polar_paper_q15_16", "PCC (1) as the paper codes it, Q15.16"},
    Named{"pcc_twin_paper_q15_16", "PCC (2) as the paper codes it, Q15.16"},
    Named{"pcc_polar_paper_int16", "PCC (1) as the paper codes it, int16 (Q8.7)"},
    Named{"pcc_twin_paper_int16", "PCC (2) as the paper codes it, int16 (Q8.7)"},
    Named{"pcc_polar_float", "exact PCC (θ, φ) by running sums, float"},
    Named{"pcc_polar_q15_16", "exact PCC (θ, φ), Q15.16"},
    Named{"pcc_polar_int16", "exact PCC (θ, φ), int16"},
    Named{"pcc_twin_float", "exact PCC (β₁, β₂), float"},
    Named{"pcc_twin_q15_16", "exact PCC (β₁, β₂), Q15.16"},
    Named{"pcc_twin_int16", "exact PCC (β₁, β₂), int16"},
    Named{"lsk_polar_float", "LSK (θ, φ), float"},
    Named{"lsk_polar_q15_16", "LSK (θ, φ), Q15.16"},
    Named{"lsk_polar_int16", "LSK (θ, φ), int16"},
    Named{"lsk_twin_float", "LSK (β₁, β₂), float"},
    Named{"lsk_twin_float_sum", "LSK (β₁, β₂), float, third tendon from the others"},
    Named{"lsk_twin_q15_16", "LSK (β₁, β₂), Q15.16"},
    Named{"lsk_twin_int16", "LSK (β₁, β₂), int16, plain C++"},
    Named{"lsk_twin_int16_mac", "LSK (β₁, β₂), int16, AVR instructions"},
    Named{"lsk_twin_int16_mac_sum", "LSK (β₁, β₂), int16, AVR instructions, third tendon from the others"},
};

std::vector<Finding> findings(const Runs& runs) {
  const KernelCycles& mac = at(runs, prototype, "lsk_twin_int16_mac");
  std::vector<Finding> all{
      quadratic(runs),
      peaks(runs),
      linear(runs, "lsk_polar_float", "LSK (θ, φ)"),
      linear(runs, "lsk_twin_float", "LSK (β₁, β₂)"),
      linear(runs, "pcc_twin_float", "exact PCC (β₁, β₂) by running sums, which the paper does not have,"),
      faster(runs),
      compare::claimed("LSK (β₁, β₂) is faster than LSK (θ, φ)", "faster",
                       fmt::format("{:.2f} times",
                                   at(runs, 5, "lsk_polar_float").mean / at(runs, 5, "lsk_twin_float").mean),
                       at(runs, 5, "lsk_polar_float").mean > at(runs, 5, "lsk_twin_float").mean ? 0 : 1, 0,
                       ""),
      {"5 sections: jitter of int16 by AVR instructions", "low wanted",
       fmt::format("{} cycles", mac.most - mac.least), "", mac.most == mac.least ? "holds" : "fails"},
  };
  for (const Named& kernel : named) all.push_back(of_kernel(runs, kernel.kernel, kernel.name));
  return all;
}

Series curve(const Runs& runs, const char* kernel, const char* label, Colour colour) {
  Series series{label, {}, {}, Mark::line_points, colour, 2};
  for (int m = 1; m <= max_sections; ++m) {
    series.x.push_back(m);
    series.y.push_back(at(runs, m, kernel).mean / 1e3);
  }
  return series;
}

Figure figure_of(const Runs& runs) {
  const Axis sections{.label = "sections M", .unit = "", .low = 1, .high = 10, .step = 1};
  Panel left{"(a) float; 16 thousand cycles are 1 ms",
             sections,
             {.label = "thousands of cycles", .unit = "", .log = true, .low = 1, .high = 3000},
             {curve(runs, "pcc_twin_paper_float", "PCC (β₁, β₂), the paper's loop", Colour::purple),
              curve(runs, "pcc_polar_paper_float", "PCC (θ, φ), the paper's loop", Colour::blue),
              curve(runs, "pcc_polar_float", "PCC (θ, φ), running sums", Colour::sky),
              curve(runs, "lsk_polar_float", "LSK (θ, φ)", Colour::vermillion),
              curve(runs, "pcc_twin_float", "PCC (β₁, β₂), running sums", Colour::green),
              curve(runs, "lsk_twin_float", "LSK (β₁, β₂)", Colour::orange)}};
  Panel right{
      "(b) LSK (β₁, β₂) by scalar",
      sections,
      {.label = "thousands of cycles", .unit = "", .low = 0, .high = 20},
      {curve(runs, "lsk_twin_q15_16", "Q15.16", Colour::blue),
       curve(runs, "lsk_twin_float", "float", Colour::orange),
       curve(runs, "lsk_twin_int16", "int16, C++", Colour::green),
       curve(runs, "lsk_twin_int16_mac", "int16, AVR instructions", Colour::vermillion),
       curve(runs, "lsk_twin_int16_mac_sum", "the same, third tendon from the others", Colour::black)}};
  left.legend = Legend::below;
  right.legend = Legend::below;
  return {.title = "Cycles of the kernels on an ATmega2560",
          .panels = {left, right},
          .columns = 2,
          .width = 1100,
          .height = 620,
          .comments = lsk::provenance("lsk/fig8", "Fig. 8")};
}

/// What the item comes to where there is nothing to measure with.
Finding not_measured(const Errors& errors) {
  return {"cycles on an ATmega2560", "drawn, not printed", "not measured: " + errors[0].message, "",
          "for information"};
}

}  // namespace

Expected<ItemResult> lsk_fig8(const StudyItem&, const fs::path& folder) {
  const auto tools = lsk::find_cycles_tools();
  if (!tools) return ItemResult{{not_measured(tools.error())}, {}, {}, {}};
  const auto runs = measure_all(*tools, folder / "fig8-firmware");
  if (!runs) return tl::unexpected(runs.error());
  return ItemResult{findings(*runs), {}, {{"fig8", table_of(*runs, *tools)}}, {{"fig8", figure_of(*runs)}}};
}

}  // namespace sinew::inline v1
