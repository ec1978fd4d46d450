#include "core/frame/marker.hpp"

namespace pleuel {

namespace {

constexpr int one = max_marker_size, two = 2 * max_marker_size;

}  // namespace

template FrameMotion<double> frame_motion(const BodyFrame&, const Coordinates<double>&,
                                          const Coordinates<double>&, const Coordinates<double>&);
template FrameMotion<Dual> frame_motion(const BodyFrame&, const Coordinates<Dual>&,
                                        const Coordinates<Dual>&, const Coordinates<Dual>&);
template FrameMotion<DualOf<one>> frame_motion(const BodyFrame&, const Coordinates<DualOf<one>>&,
                                               const Coordinates<DualOf<one>>&,
                                               const Coordinates<DualOf<one>>&);
template FrameMotion<DualOf<two>> frame_motion(const BodyFrame&, const Coordinates<DualOf<two>>&,
                                               const Coordinates<DualOf<two>>&,
                                               const Coordinates<DualOf<two>>&);

}  // namespace pleuel
