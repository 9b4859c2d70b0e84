/// @file visible.hpp
/// Texts of files as a terminal, a figure or a log may have them: what would steer it is spelled out.
#pragma once
#include <string>
#include <string_view>

namespace sinew::inline v1 {

/// The text with its control characters spelled out, `\u001b` or `\u202e`, which is JSON's spelling: C0 but
/// for line feed and tab, DEL, C1, line separators and what turns the direction of writing (Trojan Source,
/// Boucher & Anderson 2021); a byte that is not UTF-8 is `\xff`. Anything else stays as it is.
std::string visible(std::string_view text);

/// The same of a text that is to stay on its line: `\n` and `\t` are spelled out as well.
std::string visible_line(std::string_view text);

}  // namespace sinew::inline v1
