// SPDX-License-Identifier: MIT
#include "common/support/warnings.h"

#include <algorithm>
#include <utility>

namespace mmm_converter {

void Warnings::Add(std::string text) { all_.push_back({file_, motion_, std::move(text)}); }

void Warnings::AddOfKind(const std::string& kind, std::string text) {
  constexpr long kMostShown = 10;
  Kind& known = kinds_[{file_, motion_, kind}];
  ++known.count;
  if (known.count <= kMostShown) return Add(std::move(text));
  if (known.count == kMostShown + 1) {
    known.summary = all_.size();
    Add({});
  }
  all_[known.summary].text = std::to_string(known.count - kMostShown) + " more " + kind;
}

void Warnings::Append(const Warnings& more) {
  all_.insert(all_.end(), more.all_.begin(), more.all_.end());
}

void Warnings::AppendNew(const Warnings& more) {
  for (const Warning& warning : more.all_) {
    const bool is_known = std::any_of(
        all_.begin(), all_.end(), [&](const Warning& known) { return known.text == warning.text; });
    if (!is_known) all_.push_back(warning);
  }
}

std::vector<std::string> Warnings::texts() const {
  std::vector<std::string> texts(all_.size());
  std::transform(all_.begin(), all_.end(), texts.begin(),
                 [](const Warning& warning) { return warning.text; });
  return texts;
}

void Warn(Warnings* warnings, std::string text) {
  if (warnings != nullptr) warnings->Add(std::move(text));
}

void WarnOfKind(Warnings* warnings, const std::string& kind, std::string text) {
  if (warnings != nullptr) warnings->AddOfKind(kind, std::move(text));
}

WarningContext::WarningContext(Warnings* warnings, std::string file, std::string motion)
    : warnings_(warnings), file_(std::move(file)), motion_(std::move(motion)) {
  if (warnings_ == nullptr) return;
  std::swap(warnings_->file_, file_);
  std::swap(warnings_->motion_, motion_);
}

WarningContext::~WarningContext() {
  if (warnings_ == nullptr) return;
  warnings_->file_ = std::move(file_);
  warnings_->motion_ = std::move(motion_);
}

}  // namespace mmm_converter
