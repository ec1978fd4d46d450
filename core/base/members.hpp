#pragma once

#include <cstddef>
#include <type_traits>

/// The members of a plain struct, in their order and without a list of their names: what is done with
/// each, such as packing, is done with a member that is added later, too.
namespace pleuel {

inline constexpr std::size_t most_members = 26;

namespace members {

/// Whether a struct has at least so many members: as many can be initialized.
template <class Struct, std::size_t count>
constexpr bool has() {
  if constexpr (count == 1) return requires {
      Struct{{}};
    };
  if constexpr (count == 2) return requires {
      Struct{{}, {}};
    };
  if constexpr (count == 3) return requires {
      Struct{{}, {}, {}};
    };
  if constexpr (count == 4) return requires {
      Struct{{}, {}, {}, {}};
    };
  if constexpr (count == 5) return requires {
      Struct{{}, {}, {}, {}, {}};
    };
  if constexpr (count == 6) return requires {
      Struct{{}, {}, {}, {}, {}, {}};
    };
  if constexpr (count == 7) return requires {
      Struct{{}, {}, {}, {}, {}, {}, {}};
    };
  if constexpr (count == 8) return requires {
      Struct{{}, {}, {}, {}, {}, {}, {}, {}};
    };
  if constexpr (count == 9) return requires {
      Struct{{}, {}, {}, {}, {}, {}, {}, {}, {}};
    };
  if constexpr (count == 10) return requires {
      Struct{{}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
    };
  if constexpr (count == 11) return requires {
      Struct{{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
    };
  if constexpr (count == 12) return requires {
      Struct{{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
    };
  if constexpr (count == 13) return requires {
      Struct{{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
    };
  if constexpr (count == 14) return requires {
      Struct{{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
    };
  if constexpr (count == 15) return requires {
      Struct{{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
    };
  if constexpr (count == 16) return requires {
      Struct{{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
    };
  if constexpr (count == 17) return requires {
      Struct{{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
    };
  if constexpr (count == 18) return requires {
      Struct{{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
    };
  if constexpr (count == 19) return requires {
      Struct{{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
    };
  if constexpr (count == 20) return requires {
      Struct{{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
    };
  if constexpr (count == 21) return requires {
      Struct{{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
    };
  if constexpr (count == 22) return requires {
      Struct{{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {},
             {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
    };
  if constexpr (count == 23) return requires {
      Struct{{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {},
             {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
    };
  if constexpr (count == 24) return requires {
      Struct{{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {},
             {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
    };
  if constexpr (count == 25) return requires {
      Struct{{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {},
             {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
    };
  if constexpr (count == 26) return requires {
      Struct{{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {},
             {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
    };
  if constexpr (count == 27) return requires {
      Struct{{}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {},
             {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
    };
}

template <class Struct, std::size_t count = 0>
constexpr std::size_t count_from() {
  if constexpr (count == most_members + 1) {
    return count;
  } else if constexpr (has<Struct, count + 1>()) {
    return count_from<Struct, count + 1>();
  } else {
    return count;
  }
}

}  // namespace members

template <class Struct>
inline constexpr std::size_t member_count = members::count_from<Struct>();

/// Calls use(first, second, …) with all members of the struct.
/// @pre an aggregate without bases, of members that `{}` initializes; more than `most_members` and
///   others do not compile
template <class Struct, class Use>
decltype(auto) with_members(Struct& object, Use&& use) {
  constexpr std::size_t count = member_count<std::remove_const_t<Struct>>;
  static_assert(count > 0 && count <= most_members);
  if constexpr (count == 1) {
    auto& [m1] = object;
    return use(m1);
  } else if constexpr (count == 2) {
    auto& [m1, m2] = object;
    return use(m1, m2);
  } else if constexpr (count == 3) {
    auto& [m1, m2, m3] = object;
    return use(m1, m2, m3);
  } else if constexpr (count == 4) {
    auto& [m1, m2, m3, m4] = object;
    return use(m1, m2, m3, m4);
  } else if constexpr (count == 5) {
    auto& [m1, m2, m3, m4, m5] = object;
    return use(m1, m2, m3, m4, m5);
  } else if constexpr (count == 6) {
    auto& [m1, m2, m3, m4, m5, m6] = object;
    return use(m1, m2, m3, m4, m5, m6);
  } else if constexpr (count == 7) {
    auto& [m1, m2, m3, m4, m5, m6, m7] = object;
    return use(m1, m2, m3, m4, m5, m6, m7);
  } else if constexpr (count == 8) {
    auto& [m1, m2, m3, m4, m5, m6, m7, m8] = object;
    return use(m1, m2, m3, m4, m5, m6, m7, m8);
  } else if constexpr (count == 9) {
    auto& [m1, m2, m3, m4, m5, m6, m7, m8, m9] = object;
    return use(m1, m2, m3, m4, m5, m6, m7, m8, m9);
  } else if constexpr (count == 10) {
    auto& [m1, m2, m3, m4, m5, m6, m7, m8, m9, m10] = object;
    return use(m1, m2, m3, m4, m5, m6, m7, m8, m9, m10);
  } else if constexpr (count == 11) {
    auto& [m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11] = object;
    return use(m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11);
  } else if constexpr (count == 12) {
    auto& [m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12] = object;
    return use(m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12);
  } else if constexpr (count == 13) {
    auto& [m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13] = object;
    return use(m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13);
  } else if constexpr (count == 14) {
    auto& [m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14] = object;
    return use(m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14);
  } else if constexpr (count == 15) {
    auto& [m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15] = object;
    return use(m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15);
  } else if constexpr (count == 16) {
    auto& [m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15, m16] = object;
    return use(m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15, m16);
  } else if constexpr (count == 17) {
    auto& [m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15, m16, m17] = object;
    return use(m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15, m16, m17);
  } else if constexpr (count == 18) {
    auto& [m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15, m16, m17, m18] =
        object;
    return use(m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15, m16, m17, m18);
  } else if constexpr (count == 19) {
    auto& [m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15, m16, m17, m18, m19] =
        object;
    return use(m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15, m16, m17, m18,
               m19);
  } else if constexpr (count == 20) {
    auto& [m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15, m16, m17, m18, m19,
           m20] = object;
    return use(m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15, m16, m17, m18, m19,
               m20);
  } else if constexpr (count == 21) {
    auto& [m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15, m16, m17, m18, m19,
           m20, m21] = object;
    return use(m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15, m16, m17, m18, m19,
               m20, m21);
  } else if constexpr (count == 22) {
    auto& [m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15, m16, m17, m18, m19,
           m20, m21, m22] = object;
    return use(m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15, m16, m17, m18, m19,
               m20, m21, m22);
  } else if constexpr (count == 23) {
    auto& [m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15, m16, m17, m18, m19,
           m20, m21, m22, m23] = object;
    return use(m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15, m16, m17, m18, m19,
               m20, m21, m22, m23);
  } else if constexpr (count == 24) {
    auto& [m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15, m16, m17, m18, m19,
           m20, m21, m22, m23, m24] = object;
    return use(m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15, m16, m17, m18, m19,
               m20, m21, m22, m23, m24);
  } else if constexpr (count == 25) {
    auto& [m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15, m16, m17, m18, m19,
           m20, m21, m22, m23, m24, m25] = object;
    return use(m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15, m16, m17, m18, m19,
               m20, m21, m22, m23, m24, m25);
  } else if constexpr (count == 26) {
    auto& [m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15, m16, m17, m18, m19,
           m20, m21, m22, m23, m24, m25, m26] = object;
    return use(m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15, m16, m17, m18, m19,
               m20, m21, m22, m23, m24, m25, m26);
  }
}

}  // namespace pleuel
