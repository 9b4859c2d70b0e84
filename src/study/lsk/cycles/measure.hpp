/// @file measure.hpp
/// Cycles of the kernels on an ATmega2560, measured: firmware/cycles compiled by avr-g++ for the robots of
/// [LSK] Table 2 with so many sections, and run in a simulator that counts them as the part does.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "sinew/base/error.hpp"

namespace sinew::inline v1::lsk {

/// A kernel over all samples of a robot.
struct KernelCycles {
  std::string kernel;  ///< `lsk_twin_int16`: model, coordinates, scalar
  int samples = 0;
  double mean = 0;
  long least = 0, most = 0;
  /// How far its changes are from those of its model, PCC or LSK, in doubles [mm]: at most.
  double error = 0;
};

struct CyclesRun {
  int sections = 0;
  std::vector<KernelCycles> kernels;  ///< in the order of the program
  const KernelCycles* find(std::string_view kernel) const;
};

/// What measuring needs; codes of errors: `compiler_missing`, `simulator_missing`, `compiler_failed`,
/// `simulator_failed`.
struct CyclesTools {
  std::string compiler = "avr-g++", simulator;
  std::string compiler_version;  ///< first line of --version
};
Expected<CyclesTools> find_cycles_tools();

/// Compiles and runs in a folder of its own below `folder`, where the sources stay.
Expected<CyclesRun> measure_cycles(int sections, const CyclesTools& tools,
                                   const std::filesystem::path& folder);

}  // namespace sinew::inline v1::lsk
