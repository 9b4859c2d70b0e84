/// @file paths.hpp
/// Where the tree, the command and what else tests run are. Written into one source, so that the objects of
/// all others are the same in every checkout, and ccache finds them.
#pragma once

namespace sinew::test {

extern const char* const source_folder;    ///< of the project
extern const char* const command_path;     ///< the sinew command; empty where it is not built
extern const char* const fail_write_path;  ///< library to preload, whose N-th write fails
extern const char* const firmware_folder;  ///< of the firmware's images

}  // namespace sinew::test
