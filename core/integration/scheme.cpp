#include "core/integration/scheme.hpp"

namespace pleuel {

namespace {

/// Newmark's scheme, with w⁺ = (1 − w_share) a + w_share a⁺.
Scheme newmark_with(double step, double beta, double gamma, double w_share) {
  const double h = step;
  Scheme scheme;
  scheme.step = h;
  scheme.history << 1, h, h * h * (0.5 - beta), 0,  //
      0, 1, h * (1 - gamma), 0,                     //
      0, 0, 0, 0,                                   //
      0, 0, 1 - w_share, 0;
  const double a_of_z = 1 / (h * h * beta);
  scheme.correction << 1, h * gamma * a_of_z, a_of_z, w_share * a_of_z;
  scheme.local_error = (beta - 1.0 / 6.0) * h * h * h;
  return scheme;
}

}  // namespace

Scheme generalized_alpha(double step, double spectral_radius) {
  const double h = step, rho = spectral_radius;
  const double alpha_m = (2 * rho - 1) / (rho + 1), alpha_f = rho / (rho + 1);
  const double gamma = 0.5 - alpha_m + alpha_f;
  const double beta = 0.25 * (1 - alpha_m + alpha_f) * (1 - alpha_m + alpha_f);

  Scheme scheme;
  scheme.step = h;
  // With a⁺ = 0: w⁺ = (α_f a − α_m w) / (1 − α_m); z is what the true a⁺ adds to q⁺.
  const double a_share = alpha_f / (1 - alpha_m), w_share = -alpha_m / (1 - alpha_m);
  scheme.history << 1, h, h * h * beta * a_share, h * h * (0.5 - beta + beta * w_share),  //
      0, 1, h * gamma * a_share, h * (1 - gamma + gamma * w_share),                       //
      0, 0, 0, 0,                                                                         //
      0, 0, a_share, w_share;
  const double w_of_z = 1 / (h * h * beta);
  scheme.correction << 1, h * gamma * w_of_z, w_of_z * (1 - alpha_m) / (1 - alpha_f), w_of_z;
  scheme.delay = (alpha_m - alpha_f) * h;
  scheme.local_error = (beta + 0.5 * (alpha_m - alpha_f) - 1.0 / 6.0) * h * h * h;
  return scheme;
}

Scheme newmark(double step, double spectral_radius) {
  const double alpha = (1 - spectral_radius) / (1 + spectral_radius);
  return newmark_with(step, 0.25 * (1 + alpha) * (1 + alpha), 0.5 + alpha, 1.0);
}

Scheme implicit_euler(double step) {
  const double h = step;
  Scheme scheme;
  scheme.step = h;
  scheme.history << 1, h, 0, 0,  //
      0, 1, 0, 0,                //
      0, 0, 0, 0,                //
      0, 0, 0, 0;
  scheme.correction << 1, 1 / h, 1 / (h * h), 1 / (h * h);
  return scheme;
}

Scheme make_scheme(SchemeType type, double step, double spectral_radius) {
  switch (type) {
    case SchemeType::generalized_alpha:
      return generalized_alpha(step, spectral_radius);
    case SchemeType::newmark:
      return newmark(step, spectral_radius);
    default:
      return implicit_euler(step);
  }
}

Scheme make_restarting_scheme(SchemeType type, double step, double spectral_radius) {
  if (type != SchemeType::generalized_alpha) return make_scheme(type, step, spectral_radius);
  const double delta = (spectral_radius - 1) / (spectral_radius + 1);  // α_m − α_f
  return newmark_with(step, 0.25 * (1 + delta * delta), 0.5, 1 + delta);
}

}  // namespace pleuel
