#include "guard.hpp"

#include <fmt/format.h>

#include "secret.hpp"

namespace sinew::server {
namespace {

/// The value of a cookie, or nothing.
std::string_view cookie(std::string_view cookies, std::string_view name) {
  while (!cookies.empty()) {
    const std::size_t end = cookies.find(';');
    std::string_view one = cookies.substr(0, end);
    cookies.remove_prefix(end == std::string_view::npos ? cookies.size() : end + 1);
    while (one.starts_with(' ')) one.remove_prefix(1);
    if (one.starts_with(name) && one.substr(name.size()).starts_with('=')) return one.substr(name.size() + 1);
  }
  return {};
}

}  // namespace

bool is_loopback(std::string_view address) {
  return address == "localhost" || address == "::1" || address.starts_with("127.");
}

Guard::Guard(std::string_view address, int port)
    : port_(port),
      token_(is_loopback(address) ? std::string() : make_secret()) {}

bool Guard::is_own_name(std::string_view host) const {
  for (const std::string_view name : {"127.0.0.1", "localhost", "[::1]"})
    if (host == fmt::format("{}:{}", name, port_) || (port_ == 80 && host == name)) return true;
  return false;
}

bool Guard::accepts(std::string_view token) const {
  unsigned differ = token.size() != token_.size();
  for (std::size_t i = 0; i < token_.size(); ++i)
    differ |= static_cast<unsigned char>(token_[i] ^ (i < token.size() ? token[i] : '\0'));
  return differ == 0;
}

Refusal Guard::judge(const Caller& caller) const {
  // With a token, Host may be any name that the machine has: a foreign page has no cookie for it.
  if (token_.empty() && !is_own_name(caller.host)) return Refusal::foreign_host;
  if (!caller.origin.empty() && caller.origin != fmt::format("http://{}", caller.host))
    return Refusal::foreign_origin;
  if (token_.empty()) return Refusal::none;
  constexpr std::string_view bearer = "Bearer ";
  const std::string_view given = caller.authorization.starts_with(bearer)
                                     ? caller.authorization.substr(bearer.size())
                                     : cookie(caller.cookie, "sinew_token");
  return accepts(given) ? Refusal::none : Refusal::no_token;
}

}  // namespace sinew::server
