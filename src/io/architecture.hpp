/// @file architecture.hpp
/// Named architectures: the short form of a robot file.
#pragma once
#include "sinew/io/reader.hpp"
#include "sinew/robot/catalog.hpp"

namespace sinew::inline v0 {

/// The row of the catalogue that the file's `architecture` names; null (with errors noted) if there is none.
const Architecture* architecture_of(Reader& robot);

/// Legs evenly around base and platform, written as the list a file could hold itself. Reads (and so checks)
/// `base` and `platform` of `robot`.
Node legs_of(const Architecture& architecture, Reader& robot);

}  // namespace sinew::inline v0
