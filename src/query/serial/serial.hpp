/// @file serial.hpp
/// What handlers of questions to serial robots share.
#pragma once
#include <array>
#include <cmath>

#include "io/document/reader.hpp"
#include "query/handlers.hpp"
#include "query/wants.hpp"
#include "sinew/kinematics/serial.hpp"

namespace sinew::inline v1 {

/// A query put to a serial robot.
struct SerialContext : Question {
  const SerialRobot& robot;
  SerialWorkspace& work;
  explicit SerialContext(Context& context)
      : Question(context),
        robot(*context.robot.serial()),
        work(*context.work.serial) {
    work.stop = context.work.stop;
  }
};

/// Bend of a section from what the protocol calls its configuration.
inline Bend bend_of(const Section& section, const std::array<double, 2>& given) {
  return section.is_twin() ? Bend(given[0], given[1])
                           : Bend(given[0] * std::cos(given[1]), given[0] * std::sin(given[1]));
}

/// `model`: `pcc` or `lsk`.
kernel::Model read_tendon_model(SerialContext& context, kernel::Model otherwise);
/// The entries of a list of sections: at most as many as there are; the sections after them are straight.
std::vector<Reader> section_items(const SerialContext& context, const Reader& list);

/// What the two angles of a section may be [rad]: of questions, and of rows, which put others in their place.
inline constexpr Range bend_range = Range::turn();

/// Shape of all sections.
struct SerialConfiguration {
  std::vector<std::array<double, 2>> given;  ///< as a question has it, of those sections that it names
  std::vector<Bend> bends;
  std::vector<double> extensions;  ///< longer than at rest by [m]
};

/// What a query gives of the robot's shape, and what became of it.
struct Shaped : SerialConfiguration {
  std::optional<std::vector<double>> changes;
  std::vector<double> slack;  ///< of their tendons
  Report report;
};

/// Per section [θ, φ] or [β₁, β₂], and the extension where its length varies; what is not given is straight
/// and as long as at rest.
SerialConfiguration read_configuration(SerialContext& context, const Reader& list);
/// As long as the sections of the workspace are.
/// @param straight φ of each section that is straight; empty: 0
Value configuration_value(const SerialContext& context, std::span<const Bend> bends,
                          std::span<const double> straight = {});
/// What the bends ask of the tendons, per section. Uses the workspace.
Value changes_value(SerialContext& context, std::span<const Bend> bends, kernel::Model model);
/// Writes configuration, changes, motors, sections and tip, as long as the sections of the workspace are.
/// @param more what every tendon of a section is paid out beyond that [m]; empty: nothing
/// @param given changes of the first tendons, where they are known; the others are those of the bends
void put_configuration(SerialContext& context, std::span<const Bend> bends, kernel::Model model,
                       std::span<const double> more = {}, std::span<const double> given = {});

/// What a question wants of the shape, with the fields of its words.
struct SerialWants {
  Wants words;
  std::vector<double> twist;  ///< of `velocity`
  int samples = 0;            ///< of `shape`
};
SerialWants read_serial_wants(SerialContext& context);
/// Of these bends; the workspace has the sections' lengths.
void put_serial_wants(SerialContext& context, std::span<const Bend> bends, kernel::Model model,
                      const SerialWants& wanted);

/// A question of one shape.
struct SerialQuestion : SerialContext {
  using SerialContext::SerialContext;

  /// @name What was read
  /// @{
  kernel::Model model = kernel::Model::exact;
  Shaped shape = {};
  std::vector<double> pay_out = {};  ///< of all tendons of a section
  SerialWants wanted = {};
  /// @}

  void read();
  void solve();
  void tell();
};

/// @name In files of their own
/// @{
void answer_serial_inverse(Context& context);
void answer_serial_diagram(Context& context);
void answer_serial_describe(Context& context);
/// @}

}  // namespace sinew::inline v1
