// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "MMMConverterS2KF/batch/batch_outputs.h"
#include "MMMConverterS2KF/batch/batch_progress.h"
#include "MMMConverterS2KF/batch/batch_run.h"
#include "MMMConverterS2KF/batch/manifest.h"
#include "MMMConverterS2KF/batch/memory_budget.h"
#include "MMMConverterS2KF/batch/shared_inputs.h"

namespace mmm_converter {

/// What is written of a person, relative to the output folder: a subject, or where the model is one
/// of OpenSim the person's model.
std::string PersonPath(const BatchPerson& person);

/// Lets the entries use the files that their persons have in the output folder, where they may not
/// be yet.
void UsePersons(const std::string& output, BatchManifest* manifest);

/// What the parts of a run share.
struct BatchTools {
  BatchFolder* folder;
  MemoryBudget* memory;
  SharedInputs* inputs;
  BatchProgress* progress;
};

/// The persons whom entries show. Each is calibrated by one thread; others wait for it.
class BatchPersons {
 public:
  BatchPersons(const BatchManifest& manifest, const std::vector<const BatchEntry*>& entries,
               const BatchOptions& options, const BatchTools& tools);

  std::size_t count() const { return persons_.size(); }

  /// Of those whom no entry of the manifest shows.
  void WarnOfUnused() const;

  /// Calibrates the i-th person, or with --resume keeps what an earlier run has made of the same
  /// recordings and settings. To be called once for each, also where the run ends; a failure is
  /// told to those who wait. goes_on: as ConvertEntry.
  /// @throws WriteError where it concerns the disk.
  void Calibrate(std::size_t i, const std::function<bool()>& goes_on);

  /// Waits until the entry's person is calibrated, whose turn has come before.
  /// @throws Error that says why it can't be.
  void WaitFor(const BatchEntry& entry);

 private:
  struct State {
    bool has_ended = false;
    std::string failure;  ///< empty: it is calibrated
  };

  void Run(const BatchPerson& person, const std::function<bool()>& goes_on);
  bool IsDone(const BatchPerson& person, const std::string& fingerprint) const;
  void End(const BatchPerson& person, const std::string& failure);

  const BatchManifest& manifest_;
  bool resume_;
  BatchTools tools_;
  std::vector<const BatchPerson*> persons_;
  std::mutex mutex_;
  std::condition_variable ended_;
  std::map<std::string, State> states_;  // by id
};

}  // namespace mmm_converter
