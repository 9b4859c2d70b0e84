/// @file guard.hpp
/// Who may ask. A page of another site must reach nothing here: not by a name of its own for this address
/// (Host), not by a request across sites (Origin), and from other machines only who knows the token.
#pragma once
#include <string>
#include <string_view>

namespace sinew::server {

/// What a request says of where it comes from; empty: it does not say.
struct Caller {
  std::string_view host, origin, cookie, authorization;
};

enum class Refusal { none, foreign_host, foreign_origin, no_token };

class Guard {
 public:
  /// Without a token for the loopback interface alone.
  Guard(std::string_view address, int port);

  Refusal judge(const Caller& caller) const;
  /// Whether this is the token; always where there is none. Takes as long for any text.
  bool accepts(std::string_view token) const;
  /// Empty on the loopback interface.
  const std::string& token() const { return token_; }

 private:
  bool is_own_name(std::string_view host) const;

  int port_;
  std::string token_;
};

/// Addresses that only programs of this machine reach.
bool is_loopback(std::string_view address);

}  // namespace sinew::server
