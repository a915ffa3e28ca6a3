// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

namespace mmm_converter {

/// Calls body(i) for each i in [0, count), in any order, `jobs` at a time; 0: as many as there are
/// cores. An exception of a body ends the loop and is thrown again.
void ParallelFor(int count, int jobs, const std::function<void(int)>& body);

/// The number of jobs that 0 stands for.
int DefaultJobs();

}  // namespace mmm_converter
