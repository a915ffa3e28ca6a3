// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/io/osim/osim_document.h"

namespace mmm_converter {

/// What the coordinates of a model are when its locks and couplers hold: constant, free, or
/// functions of free ones.
class OsimCouplings {
 public:
  /// Errors of couplers are added to the diagnostics.
  OsimCouplings(const OsimDocument& document, Diagnostics* diagnostics);

  int Find(const std::string& coordinate) const;  ///< index; -1: there is none
  bool IsFree(int coordinate) const { return is_free_[coordinate]; }
  /// Of free coordinates only.
  const OsimExpression& ValueOf(int coordinate) const { return values_[coordinate]; }
  /// An expression in free coordinates that the document has in any. Terms that are straight have
  /// no constant of their own. line: for an error, where that can't be said by sums.
  OsimExpression InFree(const OsimExpression& expression, int line);

 private:
  void AddTerm(const OsimExpression::Term& term, int line, OsimExpression* sum);
  void Couple(const std::vector<const OsimCoupler*>& coupler_of);

  std::map<std::string, int> index_;
  Diagnostics* diagnostics_;
  std::vector<bool> is_free_;
  std::vector<OsimExpression> values_;
};

}  // namespace mmm_converter
