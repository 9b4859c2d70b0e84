#include "io/robots/read_material.hpp"
#include "io/document/reader.hpp"

namespace sinew::inline v1 {

std::optional<double> read_shear_modulus(Reader& material, double young) {
  std::optional<double> modulus;
  const auto shear = material.optional("G"), poisson = material.optional("poisson");
  if (shear) modulus = shear->quantity(Dimension::pressure, Range::positive());
  if (poisson) modulus = young / (2 + 2 * poisson->number({.low = -1, .high = 0.5, .low_excluded = true}));
  if (shear && poisson) poisson->refuse("ambiguous", "G and poisson both say how it shears; keep one");
  return modulus;
}

}  // namespace sinew::inline v1
