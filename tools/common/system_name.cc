#include "tools/common/system_name.h"

namespace leonav {

const char* name_of(System system) {
  switch (system) {
    case System::kGps:
      return "GPS";
    case System::kGalileo:
      return "Galileo";
    case System::kBeidou:
      return "BeiDou";
    case System::kLeo:
      break;
  }
  return "LEO";
}

}  // namespace leonav
