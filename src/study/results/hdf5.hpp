/// @file hdf5.hpp
/// As much of the HDF5 C library as results need: handles that close themselves, texts, errors.
#pragma once
#include <hdf5.h>

#include <string>
#include <utility>

namespace sinew::inline v1::hdf5 {

/// Not thread-safe, as the library is; errors are quiet and seen by the handles.
class Handle {
 public:
  Handle() = default;
  Handle(hid_t id, herr_t (*closes)(hid_t)) : id_(id), close_(closes) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() { close(); }

  operator hid_t() const { return id_; }  // NOLINT: as the library's functions take it
  bool ok() const { return id_ >= 0; }
  /// Whether closing, which may write, went well.
  bool close() {
    const hid_t id = std::exchange(id_, -1);
    return id < 0 || close_(id) >= 0;
  }

 private:
  hid_t id_ = -1;
  herr_t (*close_)(hid_t) = nullptr;
};

void be_quiet();    ///< the library prints no errors of its own, and loads no code that a file asks for
int last_reason();  ///< errno of the system of the last call that failed; EIO where there was none
/// Whether the system has failed since `be_quiet`, also where nobody looked: what a write has put off a
/// handle does when it closes itself.
bool has_failed();

/// A text as an attribute of an object, or as a dataset where it may be long.
bool put_attribute(hid_t object, const char* name, const std::string& text);
bool put_attribute(hid_t object, const char* name, double value);
bool put_text(hid_t group, const char* name, const std::string& text);
std::string text_attribute(hid_t object, const char* name);  ///< empty where there is none
std::string text_dataset(hid_t group, const char* name);

}  // namespace sinew::inline v1::hdf5
