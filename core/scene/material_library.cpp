#include "core/scene/material_library.hpp"

namespace pleuel {
namespace {

constexpr double MPa = 1e6, GPa = 1e9;

std::vector<Material> metals() {
  return {
      // S355J2: E, ν in EN 1993-1-1, 3.2.6; ReH for thickness up to 16 mm in EN 10025-2.
      {"steel", 210 * GPa, 0.30, 7850, 355 * MPa},
      // S960QL: the same constants; ReH for thickness up to 50 mm in EN 10025-6.
      {"high-strength-steel", 210 * GPa, 0.30, 7850, 960 * MPa},
      // 42CrMo4, quenched and tempered: Re for diameters over 40 up to 100 mm in EN ISO 683-2.
      {"heat-treated-steel-42CrMo4", 210 * GPa, 0.30, 7850, 650 * MPa},
      // 1.4301 (X5CrNi18-10), bars: E, ρ in EN 10088-1; Rp0.2 in EN 10088-3. ν as of steel.
      {"stainless-steel", 200 * GPa, 0.30, 7900, 190 * MPa},
      // EN-GJS-400-15: E, ν, ρ and Rp0.2 in EN 1563.
      {"ductile-iron-GJS-400-15", 169 * GPa, 0.275, 7100, 250 * MPa},
      // EN AW-6082 T6, profiles: E, ρ in EN 1999-1-1; Rp0.2 for walls up to 5 mm in EN 755-2. ν:
      // usual value for aluminium (EN 1999-1-1 rounds it to 0.3).
      {"aluminium-6082-T6", 70 * GPa, 0.33, 2700, 250 * MPa},
      // EN AW-7075 T6, bars: E, ν, ρ in the ASM Metals Handbook, vol. 2; Rp0.2 for diameters up to
      // 25 mm in EN 755-2.
      {"aluminium-7075-T6", 71.7 * GPa, 0.33, 2810, 480 * MPa},
      // Grade 5, annealed: E, ν, ρ in the ASM Materials Properties Handbook: Titanium Alloys; Rp0.2
      // in ASTM B348.
      {"titanium-Ti6Al4V", 113.8 * GPa, 0.342, 4430, 828 * MPa},
      // AZ31B-F, extruded: E, ν, ρ in the ASM Metals Handbook, vol. 2; Rp0.2 of thin bars in ASTM
      // B107.
      {"magnesium-AZ31", 45 * GPa, 0.35, 1770, 145 * MPa}};
}

std::vector<Material> plastics() {
  return {
      // T300/5208 carbon/epoxy, 60 % fibres, [0/±45/90]s in its plane, from the plies of Tsai &
      // Hahn, Introduction to Composite Materials (1980), tables 1.7 and 7.1: E₁ = 181, E₂ = 10.3,
      // G₁₂ = 7.17 GPa, ν₁₂ = 0.28, ρ = 1600 kg/m³. Strength: first cracks, where the strain of the
      // plies across reaches Y/E₂ = 40 MPa/10.3 GPa. Its shear modulus is E/(2 (1 + ν)) in the
      // plane
      // of the plies only.
      {"cfrp-quasi-isotropic", 69.7 * GPa, 0.296, 1600, 270 * MPa},
      // Acetal copolymer, short-time at 23 °C: data sheets of unfilled injection grades (ISO 527,
      // ISO 1183), of which Hostaform C 9021 is typical. ν: handbooks give 0.35 to 0.4. Creeps.
      {"pom", 2.85 * GPa, 0.37, 1410, 64 * MPa}};
}

}  // namespace

std::vector<Material> material_library() {
  std::vector<Material> library = metals();
  for (const Material& material : plastics()) library.push_back(material);
  return library;
}

}  // namespace pleuel
