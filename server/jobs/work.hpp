/// @file work.hpp
/// What jobs do.
#pragma once
#include "jobs.hpp"
#include "server/robots.hpp"
#include "server/watchdog.hpp"

namespace sinew::server {

/// A study that ships, by its name: its table.
Work study_work(std::string name, const JobLimits& limits);

/// Queries to a robot, answered in order by one session. One that runs is stopped when the job is over.
Work query_work(std::shared_ptr<OpenRobot> robot, std::vector<std::string> queries, Watchdog& dog);

}  // namespace sinew::server
