/// @file job_request.hpp
/// What a job is asked to do: `{"study": NAME}` or `{"robot": HANDLE, "queries": [...]}`.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "sinew/base/error.hpp"

namespace sinew::server {

struct JobRequest {
  std::string study;                      ///< empty: there are queries
  std::string robot;                      ///< handle
  std::vector<std::string_view> queries;  ///< as they stand in the body
};

/// Codes: `json_syntax`, `unknown_field`, `missing_field`, `wrong_type`.
/// @param most queries; of more there is one more than this
Expected<JobRequest> read_job(std::string_view body, std::size_t most);

}  // namespace sinew::server
