#include "study/results/hdf5.hpp"

#include <cerrno>
#include <cstdlib>
#include <string_view>

namespace sinew::inline v1::hdf5 {
namespace {

/// A text of fixed length, in UTF-8.
Handle text_type(std::size_t size) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, size > 0 ? size : 1);
  H5Tset_cset(type, H5T_CSET_UTF8);
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  return type;
}

thread_local int reason = 0;

/// The library's own texts have it: `..., errno = 28, error message = 'No space left on device', ...`.
herr_t find_reason(unsigned, const H5E_error2_t* error, void*) {
  constexpr std::string_view mark = "errno = ";
  const std::string_view text = error->desc ? error->desc : "";
  if (const std::size_t at = text.find(mark); at != std::string_view::npos)
    reason = std::atoi(error->desc + at + mark.size());
  return 0;
}

/// Called by the library where a call fails, before the next one forgets why.
herr_t remember_reason(hid_t stack, void*) { return H5Ewalk2(stack, H5E_WALK_UPWARD, find_reason, nullptr); }

/// One text of fixed length. A file may say that it has 4 GB, or that there are several, of which a buffer
/// for one is too small.
bool is_short_text(hid_t type, hid_t space) {
  constexpr std::size_t longest = std::size_t{16} << 20U;  // a robot's whole file is one
  return H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) <= 0 &&
         H5Sget_simple_extent_npoints(space) == 1 && H5Tget_size(type) <= longest;
}

std::string without_padding(std::string text) {
  text.resize(text.find_last_not_of('\0') + 1);
  return text;
}

}  // namespace

void be_quiet() {
  // At its end the library closes again what could not be closed, and crashes on a file that has no room
  // (1.10.8).
  [[maybe_unused]] static const herr_t before_anything_else = H5dont_atexit();
  reason = 0;
  H5Eset_auto2(H5E_DEFAULT, remember_reason, nullptr);
  H5PLset_loading_state(0);
}

bool has_failed() { return reason != 0; }

int last_reason() { return reason == 0 ? EIO : reason; }

bool put_attribute(hid_t object, const char* name, const std::string& text) {
  const Handle type = text_type(text.size()), space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute.ok() && H5Awrite(attribute, type, text.c_str()) >= 0;
}

bool put_attribute(hid_t object, const char* name, double value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(object, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute.ok() && H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value) >= 0;
}

bool put_text(hid_t group, const char* name, const std::string& text) {
  const Handle type = text_type(text.size()), space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle options(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(options, false);
  const Handle data(H5Dcreate2(group, name, type, space, H5P_DEFAULT, options, H5P_DEFAULT), H5Dclose);
  return data.ok() && H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()) >= 0;
}

std::string text_attribute(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return {};
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Handle type(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
  if (!is_short_text(type, space)) return {};
  std::string text(H5Tget_size(type), '\0');
  if (H5Aread(attribute, type, text.data()) < 0) return {};
  return without_padding(std::move(text));
}

std::string text_dataset(hid_t group, const char* name) {
  if (H5Lexists(group, name, H5P_DEFAULT) <= 0) return {};
  const Handle data(H5Dopen2(group, name, H5P_DEFAULT), H5Dclose);
  const Handle type(H5Dget_type(data), H5Tclose), space(H5Dget_space(data), H5Sclose);
  if (!data.ok() || !is_short_text(type, space)) return {};
  std::string text(H5Tget_size(type), '\0');
  if (H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()) < 0) return {};
  return without_padding(std::move(text));
}

}  // namespace sinew::inline v1::hdf5
