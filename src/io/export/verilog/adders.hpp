/// @file adders.hpp
/// The sum of some products in Verilog.
#pragma once
#include <string>
#include <vector>

namespace sinew::inline v1::verilog {

/// Adders by pairs with a register each, of products by factors of so many bits. Each is as wide as its sum
/// can be and no wider: see the core's module of a product.
std::string adders(const std::vector<int>& factor_bits, int levels);

}  // namespace sinew::inline v1::verilog
