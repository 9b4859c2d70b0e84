/// @file session.hpp
/// Questions and answers as JSON text, as the command, the server and other languages ask them.
#pragma once
#include "sinew/query/session.hpp"  // IWYU pragma: export
