#include "simulator/faults.hpp"

#include <algorithm>
#include <sstream>

namespace sinew::firmware {

/// Sections and tendons count from 1, as an operator's panel shows them. What is wrong; else nothing.
std::string Faults::tendon_of(int section, int tendon, std::size_t& index) const {
  const auto sections = static_cast<int>(tendons_.size());
  if (section < 1 || section > sections) return "? sections go from 1 to " + std::to_string(sections);
  const int count = tendons_[static_cast<std::size_t>(section - 1)];
  if (tendon < 1 || tendon > count) return "? tendons go from 1 to " + std::to_string(count);
  index = static_cast<std::size_t>(tendon - 1);
  for (int m = 0; m + 1 < section; ++m)
    index += static_cast<std::size_t>(tendons_[static_cast<std::size_t>(m)]);
  return {};
}

std::string Faults::obey_arm(const std::string& verb, std::size_t tendon) {
  if (verb == "state") return arm_->state();
  if (verb == "cut") arm_->cut(tendon);
  if (verb == "stick") arm_->stick(tendon);
  if (verb == "mend") arm_->mend();
  if (verb == "free") arm_->free();
  return "ok";
}

std::string Faults::obey(const std::string& line) {
  std::istringstream words(line);
  std::string verb, more;
  words >> verb;
  const bool is_of_tendon = verb == "cut" || verb == "stick";
  const bool is_of_arm = is_of_tendon || verb == "mend" || verb == "free" || verb == "state";
  std::size_t index = 0;
  if (is_of_arm && !arm_) return "? there is no arm";
  if (is_of_tendon) {
    int section = 0, tendon = 0;
    if (!(words >> section >> tendon)) return "? " + verb + " needs a section and a tendon";
    const std::string wrong = tendon_of(section, tendon, index);
    if (!wrong.empty()) return wrong;
  }
  double share = 0;
  if (verb == "noise" && (!(words >> share) || !(share >= 0 && share <= 1)))
    return "? noise needs a share from 0 to 1";
  if (words >> more) return "? nothing follows " + verb + (is_of_tendon ? " SECTION TENDON" : "");
  if (is_of_arm) return obey_arm(verb, index);
  if (verb == "noise")
    noise_ = share;
  else if (verb == "unplug")
    is_unplugged_ = true;
  else if (verb == "plug")
    is_unplugged_ = false;
  else if (verb == "reset")
    controller_.reset();
  else if (verb == "quit")
    has_quit_ = true;
  else
    return "? cut SECTION TENDON, mend, stick SECTION TENDON, free, noise SHARE, unplug, plug, reset, state, "
           "quit";
  return "ok";
}

std::string Faults::on_line(std::string bytes) {
  if (is_unplugged_) return {};
  if (noise_ > 0)
    for (char& byte : bytes)
      if (static_cast<double>(random_()) < noise_ * 4294967296.0)
        byte = static_cast<char>(byte ^ 1 << (random_() % 8));
  return bytes;
}

}  // namespace sinew::firmware
