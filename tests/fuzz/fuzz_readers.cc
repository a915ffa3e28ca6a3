// SPDX-License-Identifier: MIT
// The program of libFuzzer: fuzz_readers --target=NAME [libFuzzer's options] CORPUS...
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <string_view>

#include "tests/fuzz/fuzz_target.h"

namespace {

using mmm_converter::testing::FuzzTarget;
using mmm_converter::testing::FuzzTargets;

FuzzTarget chosen = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  constexpr std::string_view kOption = "--target=";  // libFuzzer passes over what starts with --
  for (int i = 1; i < *argc; ++i) {
    const std::string_view argument = (*argv)[i];
    if (!argument.starts_with(kOption)) continue;
    const auto found = FuzzTargets().find(std::string(argument.substr(kOption.size())));
    if (found != FuzzTargets().end()) chosen = found->second;
  }
  if (chosen != nullptr) return 0;
  std::cerr << "give one of these:\n";
  for (const auto& [name, target] : FuzzTargets()) std::cerr << kOption << name << '\n';
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mmm_converter::testing::Refusal(chosen, {reinterpret_cast<const char*>(data), size});
  return 0;
}
