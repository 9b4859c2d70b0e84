// A plugin of a user's program, with a sinew of its own.
#include "sinew/base/export.hpp"

extern "C" const char* consumer_version() { return sinew::version(); }
