// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/io/c3d/c3d_events.h"
#include "common/io/c3d/c3d_parameters.h"

namespace mmm_converter {

/// The parameter section of a C3D file while some of its parameters change. All other records stay
/// byte for byte and in their order; what cannot be told apart from padding stays as well.
class C3dSectionEdit {
 public:
  /// section: from its first byte to the data, as parameters were parsed from.
  C3dSectionEdit(std::vector<unsigned char> section, const C3dParameters& parameters,
                 std::string file);

  /// A number in place of another, in the parameter's own type; nothing where there is no such
  /// parameter. @throws Error where the type can't hold it.
  void SetNumber(const C3dParameter& parameter, int number);

  /// POINT:NAME, NAME2, ... as one list of texts; each may have the padding of the list that it is
  /// from. A list that stays as it is changes nothing. At most 255 bytes each.
  void SetPointTexts(const std::string& name, const std::vector<std::string>& texts);

  /// The texts as they are stored, with their padding.
  static std::vector<std::string> StoredTexts(const C3dParameters& parameters,
                                              const std::string& name);

  /// EVENT:USED, TIMES, LABELS, CONTEXTS, SUBJECTS and ICON_IDS of these events, in place of
  /// what the group has of its own, DESCRIPTIONS too. @throws Error where there are more than 255.
  void SetEvents(const std::vector<C3dEvent>& events);

  /// Whether a list of texts changes, or the events.
  bool HasNewTexts() const { return !edits_.empty(); }

  /// Makes the section say of itself that it has all blocks up to the data.
  void StateSize();

  /// How many blocks longer the section becomes by these.
  /// @throws Error where it would need more than 255.
  std::size_t MoreBlocks() const;

  /// The changed section, whose own header counts its blocks. @throws Error as MoreBlocks.
  std::vector<unsigned char> Finish() const;

 private:
  struct Edit {
    std::size_t begin, end;
    std::string bytes;
  };
  C3dProcessor processor() const;
  /// A parameter of POINT that others can follow; null: there is none.
  const C3dParameter* FindOfPoints() const;
  /// The number of a group, which is begun where there is none.
  int GroupOf(const std::string& name);
  std::size_t ZerosBehindRecords() const;

  std::vector<unsigned char> section_;
  const C3dParameters& parameters_;
  std::string file_;
  std::vector<Edit> edits_;
  std::map<std::string, int> new_groups_;
};

}  // namespace mmm_converter
