#include "core/smoother/relink.h"

namespace leonav {

void Relinker::operator()(const Keyframe&, Keyframe*) {}

}  // namespace leonav
