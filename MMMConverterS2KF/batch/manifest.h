// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/pipeline/conversion.h"

namespace mmm_converter {

/// A recording of a batch, with what holds for it.
struct BatchEntry {
  std::string id;             ///< names its outputs: a relative path without ending, "1723/Cut"
  std::string group;          ///< names of the groups around it, outermost first, "KIT / 1723"
  int line = 0;               ///< in the manifest
  ConversionRequest request;  ///< without outputs
  std::string person;         ///< id of the BatchPerson whom it shows; empty: none
  std::map<std::string, std::string> settings;  ///< the attributes that the request is made of
  std::set<std::string> exports;                ///< "csv", "mot", "trc", "lafan1": written too
  std::map<std::string, std::string> metadata;  ///< passed on to the results
};

/// A `<Person>`: calibrated once by its recordings, for all entries that name it.
struct BatchPerson {
  std::string id;  ///< names its files, as that of an entry
  int line = 0;    ///< in the manifest
  std::vector<std::string> recordings;
  BatchEntry settings;  ///< what holds for each of these; the request's file is the first
};

/// A `<Batch>` file (ManifestSchema). An attribute of <Batch> or <Group> holds for
/// every recording inside; of several, the innermost.
struct BatchManifest {
  std::string file;  ///< for messages
  std::string name;
  std::vector<BatchEntry> entries;             ///< in the file's order; ids are unique
  std::map<std::string, BatchPerson> persons;  ///< by id
};

/// @throws Error with file and line for all that is not well-formed or not allowed.
BatchManifest ReadManifest(const std::string& path);

/// As ReadManifest, from text. Relative paths start at the folder of `file`, which need not exist.
BatchManifest ParseManifest(const std::string& xml, const std::string& file);

/// Whether an id may name outputs: a relative path without . and .., in UTF-8, without control
/// characters and \\.
bool IsPlainId(const std::string& id);

/// A documented manifest with every attribute.
std::string ManifestTemplate();

/// 1-based part of `shards`: every entry is in one of them, which depends on its place only.
std::vector<const BatchEntry*> ShardOf(const std::vector<BatchEntry>& entries, int shard,
                                       int shards);

}  // namespace mmm_converter
