#include "core/frame/body_frame.hpp"

namespace pleuel {

template FrameMotion<double> frame_motion(const BodyFrame&, const Coordinates<double>&,
                                          const Coordinates<double>&, const Coordinates<double>&);
template FrameMotion<Dual> frame_motion(const BodyFrame&, const Coordinates<Dual>&,
                                        const Coordinates<Dual>&, const Coordinates<Dual>&);
template FrameMotion<WideDual> frame_motion(const BodyFrame&, const Coordinates<WideDual>&,
                                            const Coordinates<WideDual>&,
                                            const Coordinates<WideDual>&);

}  // namespace pleuel
