#include <algorithm>
#include <iterator>

#include "drivers/sbf/sbf_decoder.h"

namespace leonav {
namespace {

struct BlockName {
  std::uint16_t number;
  const char* text;
};

constexpr BlockName kNames[] = {
    {4000, "MeasExtra (noise and corrections of measurements)"},
    {4001, "DOP"},
    {4004, "GLONav (system not used)"},
    {4006, "PVTCartesian"},
    {4007, "PVTGeodetic"},
    {4012, "SatVisibility"},
    {4013, "ChannelStatus"},
    {4014, "ReceiverStatus"},
    {4020, "GEORawL1 (system not used)"},
    {4021, "GEORawL5 (system not used)"},
    {4026, "GLORawCA (system not used)"},
    {4030, "GALIon"},
    {4031, "GALUtc"},
    {4032, "GALGstGps"},
    {4036, "GLOTime (system not used)"},
    {4042, "GPSCNav"},
    {4045, "INSNavCart (the receiver's own solution)"},
    {4046, "INSNavGeod (the receiver's own solution)"},
    {4056, "ExtSensorStatus"},
    {4066, "QZSRawL1CA (system not used)"},
    {4067, "QZSRawL2C (system not used)"},
    {4068, "QZSRawL5 (system not used)"},
    {4082, "QualityInd"},
    {4092, "RFStatus"},
    {4093, "NAVICRaw (system not used)"},
    {4095, "QZSNav (system not used)"},
    {4109, "Meas3Ranges (turn on MeasEpoch)"},
    {4110, "Meas3CN0HiRes (turn on MeasEpoch)"},
    {4111, "Meas3Doppler (turn on MeasEpoch)"},
    {4112, "Meas3PP (turn on MeasEpoch)"},
    {4113, "Meas3MP (turn on MeasEpoch)"},
    {4120, "BDSIon"},
    {4121, "BDSUtc"},
    {4221, "GPSRawL1C (CNAV-2)"},
    {4224, "IMUSetup"},
    {4225, "INSSupport"},
    {4251, "BDSCNav1 (turn on BDSNav)"},
    {4252, "BDSCNav2 (turn on BDSNav)"},
    {4253, "BDSCNav3 (turn on BDSNav)"},
    {5889, "MeasEpoch of old firmware (turn on the present one)"},
    {5892, "GPSAlm"},
    {5894, "GPSUtc"},
    {5902, "ReceiverSetup"},
    {5905, "PosCovCartesian"},
    {5906, "PosCovGeodetic"},
    {5907, "VelCovCartesian"},
    {5908, "VelCovGeodetic"},
    {5914, "ReceiverTime"},
    {5919, "DiffCorrIn"},
    {5921, "EndOfPVT"},
    {5922, "EndOfMeas"},
    {5938, "AttEuler"},
    {5939, "AttCovEuler"},
};

}  // namespace

std::string unused_block_text(std::uint16_t number) {
  const auto found =
      std::find_if(std::begin(kNames), std::end(kNames),
                   [number](const BlockName& name) { return name.number == number; });
  if (found == std::end(kNames)) return "block " + std::to_string(number);
  return found->text;
}

}  // namespace leonav
