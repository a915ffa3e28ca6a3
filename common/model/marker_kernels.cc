// SPDX-License-Identifier: MIT
#include "common/model/marker_kernels.h"

#include "common/math/lanes.h"

namespace mmm_converter::MMM_CONVERTER_VARIANT {
namespace {

static_assert(kFrameSize >= 12 * kLanes);

/// The frame of a link in a group of samples: rows of R, then p.
struct Frame {
  Lanes R[9];
  Lanes p[3];
};

Frame LoadFrame(const double* source) {
  Frame frame = {};
  for (int i = 0; i < 9; ++i) frame.R[i] = LoadLanes(source + i * kLanes);
  for (int i = 0; i < 3; ++i) frame.p[i] = LoadLanes(source + (9 + i) * kLanes);
  return frame;
}

void StoreFrame(const Frame& frame, double* target) {
  for (int i = 0; i < 9; ++i) StoreLanes(frame.R[i], target + i * kLanes);
  for (int i = 0; i < 3; ++i) StoreLanes(frame.p[i], target + (9 + i) * kLanes);
}

/// R = R C with a constant C, column-major.
void Rotate(const double* C, Frame* frame) {
  for (int row = 0; row < 3; ++row) {
    Lanes* r = frame->R + 3 * row;
    const Lanes a = r[0];
    const Lanes b = r[1];
    const Lanes c = r[2];
    for (int col = 0; col < 3; ++col) {
      r[col] = a * C[3 * col] + b * C[3 * col + 1] + c * C[3 * col + 2];
    }
  }
}

/// Component `row` of p + R t.
Lanes Transform(const Frame& frame, const double* t, int row) {
  const Lanes* r = frame.R + 3 * row;
  return frame.p[row] + r[0] * t[0] + r[1] * t[1] + r[2] * t[2];
}

/// R = R Rot(axis, angle).
template <int kAxis>
void Turn(const Lanes& angle, Frame* frame) {
  constexpr int kU = (kAxis + 1) % 3;
  constexpr int kV = (kAxis + 2) % 3;
  Lanes sine;
  Lanes cosine;
  SinCos(angle, &sine, &cosine);
  for (int row = 0; row < 3; ++row) {
    Lanes* r = frame->R + 3 * row;
    const Lanes a = r[kU];
    const Lanes b = r[kV];
    r[kU] = a * cosine + b * sine;
    r[kV] = b * cosine - a * sine;
  }
}

void MoveToChild(const TrackedLink& link, const Lanes& angle, Frame* frame) {
  if (link.translated) {
    for (int row = 0; row < 3; ++row) frame->p[row] = Transform(*frame, link.p_PF, row);
  }
  if (link.rotated) Rotate(link.R_PF, frame);
  if (link.axis == 0) {
    Turn<0>(angle, frame);
  } else if (link.axis == 1) {
    Turn<1>(angle, frame);
  } else {
    Turn<2>(angle, frame);
  }
}

void Slide(const TrackedLink& link, const Lanes& way, Frame* frame) {
  for (int row = 0; row < 3; ++row) {
    const Lanes* r = frame->R + 3 * row;
    const double* s = link.slide_P;
    frame->p[row] =
        Transform(*frame, link.p_PF, row) + way * (r[0] * s[0] + r[1] * s[1] + r[2] * s[2]);
  }
  if (link.rotated) Rotate(link.R_PF, frame);
}

template <bool kAnySlides>
void PlaceMarkers(const TrackedLink* links, int num_links, const MarkerSite* sites,
                  const MarkerBatchColumns& batch) {
  for (std::ptrdiff_t row = 0; row < batch.rows; row += kLanes) {
    Frame frame = {};
    for (int i = 0; i < 9; ++i) frame.R[i] = LoadLanes(batch.rotation + i * batch.rows + row);
    for (int i = 0; i < 3; ++i) frame.p[i] = LoadLanes(batch.position + i * batch.rows + row);
    for (int l = 0; l < num_links; ++l) {
      const TrackedLink& link = links[l];
      if (l > 0) {
        if (link.parent != l - 1) frame = LoadFrame(batch.frames + link.parent * kFrameSize);
        const double* angles = batch.angles + link.column * batch.rows + row;
        if (kAnySlides && link.slides) {
          Slide(link, LoadLanes(angles), &frame);
        } else {
          MoveToChild(link, link.slope * LoadLanes(angles), &frame);
        }
      }
      if (link.kept) StoreFrame(frame, batch.frames + l * kFrameSize);
      const MarkerSite* site = sites + link.first_site;
      for (int i = 0; i < link.num_sites; ++i, ++site) {
        double* target = batch.markers + 3 * site->marker * batch.rows + row;
        for (int k = 0; k < 3; ++k) {
          StoreLanes(Transform(frame, site->p_LM, k), target + k * batch.rows);
        }
      }
    }
  }
}

}  // namespace

const MarkerKernels& GetMarkerKernels() {
  static constexpr MarkerKernels kKernels = {PlaceMarkers<false>, PlaceMarkers<true>};
  return kKernels;
}

}  // namespace mmm_converter::MMM_CONVERTER_VARIANT
