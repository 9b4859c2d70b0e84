#include "io/measured/measurement.hpp"
#include "io/document/reader.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sinew::inline v1 {
namespace {

constexpr Range gains{.low = 0, .high = 1e3, .low_excluded = true};
constexpr Range times{.low = 0, .high = 1e6};
constexpr Range lengths{.low = 0, .high = Range::size().high};

void refuse_count(const Reader& list, std::size_t found, std::size_t needed, std::string_view of) {
  list.fail("wrong_tendon_count",
            fmt::format("there are {} values for {} tendon{}{}; give one for each, or one quantity for all.",
                        found, needed, needed == 1 ? "" : "s", of));
}

/// One quantity for all tendons, one for each, or for each section a list of one for each that ends there.
std::vector<double> read_per_tendon(const Reader& place, const Arm& arm, Dimension dimension, Range range) {
  const std::size_t tendons = arm.tendons.size();
  if (!place.is(Node::Kind::list)) return std::vector<double>(tendons, place.quantity(dimension, range));
  const auto items = place.items();
  if (std::ranges::none_of(items, [](const Reader& item) { return item.is(Node::Kind::list); })) {
    auto values = place.quantities(dimension, range);
    if (values.size() != tendons) refuse_count(place, values.size(), tendons, " of the arm");
    values.resize(tendons, 1);
    return values;
  }
  const std::vector<std::size_t> counts = tendon_counts(arm);
  if (items.size() != counts.size()) {
    place.fail(
        "wrong_tendon_count",
        fmt::format("there are {} lists for {} section{}; give a list for each, [] where no tendon ends.",
                    items.size(), counts.size(), counts.size() == 1 ? "" : "s"));
    return std::vector<double>(tendons, 1);
  }
  std::vector<double> values;
  for (std::size_t m = 0; m < counts.size(); ++m) {
    auto own = items[m].quantities(dimension, range);
    if (items[m].is(Node::Kind::list) && own.size() != counts[m])
      refuse_count(items[m], own.size(), counts[m],
                   fmt::format(" that end{} there", counts[m] == 1 ? "s" : ""));
    own.resize(counts[m], 1);
    values.insert(values.end(), own.begin(), own.end());
  }
  return values;
}

TendonDrive read_drive(Reader& map, const Arm& arm) {
  TendonDrive drive;
  if (const auto gain = map.optional("gain"))
    drive.gain = read_per_tendon(*gain, arm, Dimension::number, gains);
  if (const auto offset = map.optional("offset"))
    drive.offset = read_per_tendon(*offset, arm, Dimension::length, Range::place());
  if (const auto toe = map.optional("toe"))
    drive.toe = read_per_tendon(*toe, arm, Dimension::length, lengths);
  if (const auto lag = map.optional("lag")) drive.lag = lag->quantity(Dimension::time, times);
  if (const auto play = map.optional("play")) drive.play = play->quantity(Dimension::length, lengths);
  map.close();
  return drive;
}

MarkerMount read_marker(Reader& map) {
  MarkerMount marker;
  if (const auto place = map.optional("place"))
    marker.place = place->array<3>(Dimension::length, Range::place());
  if (const auto base = map.optional("base")) marker.base = base->array<3>(Dimension::length, Range::place());
  if (const auto tilt = map.optional("tilt"))
    marker.tilt = tilt->array<3>(Dimension::angle, Range::between(-100, 100));
  map.close();
  return marker;
}

}  // namespace

std::vector<std::size_t> tendon_counts(const Arm& arm) {
  std::vector<std::size_t> counts(arm.sections.size());
  for (const ArmTendon& tendon : arm.tendons) ++counts[static_cast<std::size_t>(tendon.section())];
  return counts;
}

std::vector<std::string> tendon_names(const Arm& arm) {
  std::vector<std::size_t> counts(arm.sections.size());
  std::vector<std::string> names;
  for (const ArmTendon& tendon : arm.tendons) {
    const auto m = static_cast<std::size_t>(tendon.section());
    names.push_back(fmt::format("sections[{}].tendons[{}]", m, counts[m]++));
  }
  return names;
}

MeasuringSetup read_measurement(Reader& measurement, const Arm& arm) {
  MeasuringSetup result;
  if (auto drive = measurement.optional("drive")) result.drive = read_drive(*drive, arm);
  if (auto marker = measurement.optional("marker")) result.marker = read_marker(*marker);
  measurement.close();
  return result;
}

}  // namespace sinew::inline v1
