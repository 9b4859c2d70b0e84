#include "secret.hpp"

#include <fmt/format.h>
#include <sys/random.h>

#include <array>
#include <cstdint>
#include <stdexcept>

namespace sinew::server {

std::string make_secret() {
  std::array<std::uint64_t, 2> bits{};
  if (getrandom(bits.data(), sizeof bits, 0) != static_cast<ssize_t>(sizeof bits))
    throw std::runtime_error("the system gives no random numbers");
  return fmt::format("{:016x}{:016x}", bits[0], bits[1]);
}

}  // namespace sinew::server
