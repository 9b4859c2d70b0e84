#include "study/reproduce.hpp"

#include <algorithm>
#include <iterator>

#include "study/item.hpp"

namespace sinew::inline v1 {
namespace {

constexpr StudyItem items[] = {
    {"tdpcr/fig8", "Initial configuration of the 3-RFR of section 5.1, constant curvature", tdpcr_fig8},
    {"tdpcr/fig9", "Performance indices of the 3-RFR along the trajectory of section 5.1, constant curvature",
     tdpcr_fig9},
    {"tdpcr/fig10", "Last pose of the trajectory of section 5.1: the lines of the 3-RFR meet in one point",
     tdpcr_fig10},
    {"tdpcr/fig11",
     "Performance indices of the 3-RFR along the trajectory of section 5.1, pseudo-rigid chains",
     tdpcr_fig11},
    {"tdpcr/fig12", "Last pose of the trajectory of section 5.1 on pseudo-rigid chains", tdpcr_fig12},
    {"tdpcr/chains", "Pseudo-rigid chains of n links against the elastica: orders of chord and turn",
     tdpcr_chains},
    {"3pfs/fig4", "Parasitic motions of the rigid tripod 3PRS over its tilts", tripod_fig4},
    {"3pfs/fig5", "Singularity loci of the 3PRS over its tilts: of inverse and of forward kinematics",
     tripod_fig5},
    {"3pfs/fig6", "Norm of the inverse kinematics' Jacobian of the 3PRS over its tilts", tripod_fig6},
    {"3pfs/fig7", "Norm of the forward kinematics' Jacobian of the 3PRS over its tilts", tripod_fig7},
    {"3pfs/fig9", "Joint space of the flexible tripod 3PFS and its workspace", tripod_fig9},
    {"3pfs/fig10", "The part of the joint space of the 3PFS that keeps a height", tripod_fig10},
    {"3pfs/fig11", "Parasitic turn e₃ of the 3PFS beside the rigid 3PRS, at three heights", tripod_fig11},
    {"3pfs/fig12", "Parasitic shift x_p of the 3PFS beside the rigid 3PRS, at three heights", tripod_fig12},
    {"3pfs/fig13", "Parasitic shift y_p of the 3PFS beside the rigid 3PRS, at three heights", tripod_fig13},
    {"3pfs/equation36", "Parasitic motion of the 3PFS as polynomials of its tilt, equation (36)",
     tripod_equation36},
    {"3pfs/fig14", "What a vertical force does to the poses of the 3PFS", tripod_fig14},
    {"3pfs/fig15", "What a moment about x does to the poses of the 3PFS", tripod_fig15},
    {"3pfs/fig16", "What a moment about y does to the poses of the 3PFS", tripod_fig16},
    {"3pfs/table1", "Relative RMS error between loaded and unloaded poses of the 3PFS, rods of 3 mm",
     tripod_table1},
    {"3pfs/table2", "Relative RMS error between loaded and unloaded poses of the 3PFS, rods of 4 mm",
     tripod_table2},
    {"3pfs/design", "Parasitic motion of the flexible tripod by pair angle, height, radius and diameter",
     tripod_design},
    {"lsk/fig3", "Length of a tendon past one joint: constant curvature and linearised", lsk_fig3},
    {"lsk/fig4", "How the diagram of a section is built: vector and frontier of a tendon", lsk_fig4},
    {"lsk/fig5", "Tendons that agree on one bend, on many, on none, or beyond the limits only", lsk_fig5},
    {"lsk/fig6", "The diagram of a section with a neutral backbone, in polar coordinates", lsk_fig6},
    {"lsk/fig7", "Relative error of the linearised length and the parabola through it", lsk_fig7},
    {"lsk/fig8", "Cycles of the kernels against the number of sections, on an ATmega2560", lsk_fig8},
    {"lsk/fig9", "Error of a tendon's length in floating and fixed point, by three formulas", lsk_fig9},
    {"lsk/numbers", "Numbers derived in the text: sizes, travel, evaluations, errors, misprints",
     lsk_numbers},
    {"truth/tables", "Rods whose shapes are published: cantilever, loads along it, bend of 45 degrees",
     truth_tables},
    {"truth/rods", "250 shapes each of two rods under gravity and wrenches, by another code", truth_rods},
    {"truth/arms", "Two measured arms, identified: rows of the fit, single pulls, rows not seen", truth_arms},
    {"truth/models", "An arm by five models of its backbone: how far apart, and what each costs",
     truth_models},
};

/// A bar would end the cell, and a line break the table.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out;
}

}  // namespace

std::span<const StudyItem> study_items() { return items; }

// What cannot be drawn, without gnuplot say, keeps nothing else from being there.
Expected<Reproduction> write_item(const StudyItem& item, const ItemResult& made,
                                  const std::filesystem::path& folder, const FigureOptions& page) {
  Reproduction result{std::string(item.id), std::string(item.title), made.findings, made.swept};
  for (const auto& [name, table] : made.tables) {
    result.files.push_back(folder / (name + ".csv"));
    if (auto done = write_csv(table, result.files.back()); !done)
      return tl::unexpected(std::move(done.error()));
  }
  result.files.push_back(folder / (std::string(item.id.substr(item.id.find('/') + 1)) + ".md"));
  if (auto done = write_text(to_markdown(result), result.files.back()); !done)
    return tl::unexpected(std::move(done.error()));
  Errors errors;
  for (const auto& [name, figure] : made.figures) {
    const auto files = write_figure(figure, folder / name, page);
    if (files)
      result.files.insert(result.files.end(), files->begin(), files->end());
    else
      errors.insert(errors.end(), files.error().begin(), files.error().end());
  }
  if (!errors.empty()) return tl::unexpected(std::move(errors));
  return result;
}

Expected<Reproduction> reproduce(std::string_view id, const std::filesystem::path& out,
                                 const FigureOptions& page) {
  const auto item = std::ranges::find(items, id, &StudyItem::id);
  if (item == std::end(items)) {
    std::string known;
    for (const StudyItem& one : items) known += (known.empty() ? "" : ", ") + std::string(one.id);
    return failure("unknown_study", id, "there is no such figure or table here; there are: " + known);
  }
  const std::filesystem::path folder = out / std::string(id.substr(0, id.find('/')));
  const auto made = item->make(*item, folder);
  if (!made) return tl::unexpected(made.error());
  return write_item(*item, *made, folder, page);
}

std::string to_markdown(const Reproduction& reproduction) {
  std::string text = "# " + reproduction.id + ": " + reproduction.title + "\n\n";
  text += "| quantity | " + std::string(reproduction.compared_with()) +
          " | ours | difference | verdict |\n|---|---|---|---|---|\n";
  for (const Finding& finding : reproduction.findings) {
    for (const std::string* part :
         {&finding.quantity, &finding.paper, &finding.ours, &finding.difference, &finding.verdict})
      text += "| " + cell(*part) + ' ';
    text += "|\n";
  }
  return text;
}

}  // namespace sinew::inline v1
