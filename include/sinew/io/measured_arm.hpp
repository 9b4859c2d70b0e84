/// @file measured_arm.hpp
/// Files around an identification: arms as files, and tables of measured rows. Formats: docs/robot-files.md,
/// docs/identify.md
#pragma once
#include <span>
#include <string>
#include <vector>

#include "sinew/analysis/identify.hpp"
#include "sinew/base/error.hpp"
#include "sinew/base/export.hpp"
#include "sinew/io/table.hpp"
#include "sinew/robot/arm.hpp"

namespace sinew::inline v1 {

/// The text of a file that reads as this arm: numbers in SI with all their digits, backbones by their
/// stiffness, every tendon by itself. Codes: `not_available` where a file cannot say it, and those of
/// `read_arm` where it is no arm.
/// @param comments lines at the top, without the `#`
SINEW_API Expected<std::string> arm_text(const Arm& arm, std::span<const std::string> comments = {});

/// Measured rows in a table with the columns `sections[0].tendons[0][mm]` for each tendon, drawn in where
/// positive, `x[mm]`, `y[mm]`, `z[mm]` of the marker, and, where wanted, `time[s]` and `block`. Units may be
/// others of their kind; columns of other names are left aside. Codes: `missing_column`, `missing_unit`,
/// `wrong_dimension`, `unknown_unit`, `not_a_number`, `not_whole`, `out_of_range`, `not_in_order`,
/// `too_many_tendons`, `no_rows`.
/// @param file names the table in errors
SINEW_API Expected<MeasuredRows> read_measured_rows(const Table& table, const Arm& arm,
                                                    const std::string& file);

/// The same rows as a table in mm and s.
SINEW_API Table measured_table(const MeasuredRows& rows, const Arm& arm);

}  // namespace sinew::inline v1
