// SPDX-License-Identifier: MIT
#include "common/io/osim/osim_couplings.h"

#include <fmt/format.h>

#include <algorithm>

namespace mmm_converter {
namespace {

// Real models have 1, and splines of some 20 points. Chains of couplers could multiply both.
constexpr std::size_t kMostTerms = 16;
constexpr std::size_t kMostNumbers = 4096;
constexpr int kLongestCoupling = 16;  // of couplers; real models have 1

}  // namespace

OsimCouplings::OsimCouplings(const OsimDocument& document, Diagnostics* diagnostics)
    : diagnostics_(diagnostics) {
  const std::size_t count = document.coordinates.size();
  is_free_.assign(count, true);
  values_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const OsimCoordinate& one = document.coordinates[i];
    index_.emplace(one.name, static_cast<int>(i));
    is_free_[i] = !one.IsHeld();
    values_[i].constant = one.is_locked ? one.default_value : one.lower;
    if (one.IsHeld()) continue;
    values_[i] = OsimExpression();
    values_[i].terms.push_back({one.name, ScalarFunction()});
  }
  std::vector<const OsimCoupler*> coupler_of(count, nullptr);
  for (const OsimCoupler& coupler : document.couplers) {
    const int dependent = Find(coupler.dependent);
    std::string unknown = dependent < 0 ? coupler.dependent : "";
    for (const auto& term : coupler.value.terms) {
      if (Find(term.coordinate) < 0) unknown = term.coordinate;
    }
    if (!unknown.empty() || dependent < 0) {
      diagnostics->AddError(coupler.line, fmt::format("coupler '{}': the model has no coordinate "
                                                      "\"{}\"",
                                                      coupler.name, unknown));
    } else if (coupler_of[dependent] != nullptr) {
      diagnostics->AddError(
          coupler.line, fmt::format("coupler '{}': coordinate '{}' follows '{}' already",
                                    coupler.name, coupler.dependent, coupler_of[dependent]->name));
    } else if (is_free_[dependent]) {
      coupler_of[dependent] = &coupler;
      is_free_[dependent] = false;
    }
  }
  if (diagnostics->errors().empty()) Couple(coupler_of);
}

/// Chain by chain, from what is known on.
void OsimCouplings::Couple(const std::vector<const OsimCoupler*>& coupler_of) {
  std::vector<std::vector<int>> followers(coupler_of.size());
  std::vector<int> open(coupler_of.size(), 0);  // leaders that are not known yet
  std::vector<int> chain(coupler_of.size(), 1);
  std::vector<int> known;
  std::size_t waiting = 0;
  for (std::size_t i = 0; i < coupler_of.size(); ++i) {
    if (coupler_of[i] == nullptr) continue;
    ++waiting;
    for (const auto& term : coupler_of[i]->value.terms) {
      const int leader = Find(term.coordinate);
      if (coupler_of[leader] == nullptr) continue;
      followers[leader].push_back(static_cast<int>(i));
      ++open[i];
    }
    if (open[i] == 0) known.push_back(static_cast<int>(i));
  }
  while (!known.empty()) {
    const int one = known.back();
    known.pop_back();
    --waiting;
    values_[one] = InFree(coupler_of[one]->value, coupler_of[one]->line);
    if (chain[one] > kLongestCoupling) {
      diagnostics_->AddError(coupler_of[one]->line,
                             fmt::format("coupler '{}' follows more than {} others one by one",
                                         coupler_of[one]->name, kLongestCoupling));
      return;
    }
    for (const int follower : followers[one]) {
      chain[follower] = std::max(chain[follower], chain[one] + 1);
      if (--open[follower] == 0) known.push_back(follower);
    }
  }
  if (waiting == 0) return;
  for (std::size_t i = 0; i < coupler_of.size(); ++i) {
    if (open[i] == 0) continue;
    diagnostics_->AddError(coupler_of[i]->line,
                           fmt::format("coupler '{}': coordinate '{}' follows itself by way of "
                                       "other couplers",
                                       coupler_of[i]->name, coupler_of[i]->dependent));
    return;
  }
}

int OsimCouplings::Find(const std::string& coordinate) const {
  const auto found = index_.find(coordinate);
  return found == index_.end() ? -1 : found->second;
}

void OsimCouplings::AddTerm(const OsimExpression::Term& term, int line, OsimExpression* sum) {
  const int index = Find(term.coordinate);
  if (index < 0) return;
  const OsimExpression& value = values_[index];
  const auto straight = term.function.AsLine();
  if (value.terms.empty()) {
    sum->constant += term.function.Value(value.constant);
  } else if (straight) {
    sum->constant += straight->slope * value.constant + straight->offset;
    if (straight->slope == 0) return;
    for (const auto& one : value.terms) {
      sum->terms.push_back({one.coordinate, one.function.Scaled(straight->slope)});
    }
  } else if (value.terms.size() == 1) {
    const auto& one = value.terms.front();
    const ScalarFunction inner = ScalarFunction::Linear(1, value.constant).After(one.function);
    sum->terms.push_back({one.coordinate, term.function.After(inner)});
  } else {
    diagnostics_->AddError(line, fmt::format("a function that is not linear of coordinate '{}', "
                                             "which follows several others, is not read",
                                             term.coordinate));
  }
}

OsimExpression OsimCouplings::InFree(const OsimExpression& expression, int line) {
  OsimExpression sum;
  sum.constant = expression.constant;
  for (const auto& term : expression.terms) AddTerm(term, line, &sum);
  std::size_t numbers = 0;
  for (const auto& term : sum.terms) numbers += term.function.size();
  if (sum.terms.size() > kMostTerms || numbers > kMostNumbers) {
    diagnostics_->AddError(line, fmt::format("what moves here is a sum of {} functions of {} "
                                             "numbers, more than the {} of {} that are read",
                                             sum.terms.size(), numbers, kMostTerms, kMostNumbers));
    return {};
  }
  for (auto& term : sum.terms) {
    const auto straight = term.function.AsLine();
    if (!straight) continue;
    sum.constant += straight->offset;
    term.function = ScalarFunction::Linear(straight->slope, 0);
  }
  return sum;
}

}  // namespace mmm_converter
