// Made by test/oracle/broadcast_orbits.py: broadcast elements of 2020-06-25 and what
// RTKLIB's eph2pos makes of them.
#pragma once
#include <cmath>
#include <vector>

#include "core/gnss/orbits/satellite_state.h"

namespace leonav::test {

struct BroadcastCase {
  Ephemeris ephemeris;
  double since_toe_s;
  Eigen::Vector3d p_e;
  double clock_s;
};

inline std::vector<BroadcastCase> rtklib_broadcast_cases() {
  std::vector<BroadcastCase> cases;
  {
    Ephemeris e;
    e.satellite = {System::kBeidou, 5};
    e.message = NavigationMessage::kBeidouD2;
    e.toe = GpsTime::from_week_and_tow(2111, 338414.0);
    e.toc = GpsTime::from_week_and_tow(2111, 338414.0);
    e.sqrt_a = std::sqrt(42163970.189848535);
    e.eccentricity = 0.0003830116475001;
    e.m0 = -1.101749161212;
    e.delta_n = -3.141559429989e-09;
    e.omega0 = 2.697580724014;
    e.omega_dot = 4.100527946305e-09;
    e.i0 = 0.1136268367853;
    e.i_dot = 3.321566928024e-10;
    e.omega = -1.027125663175;
    e.cuc = -1.366203650832e-05;
    e.cus = -1.177610829473e-05;
    e.crc = 354.984375;
    e.crs = -414.296875;
    e.cic = -6.146728992462e-08;
    e.cis = 6.146728992462e-08;
    e.af0 = -0.0005154609680176;
    e.af1 = -6.708145150469e-11;
    e.af2 = 0.0;
    cases.push_back(
        {e, -7200.0, {21924393.6436, 36013262.4374, -480523.6227}, -5.1497687837665e-04});
    cases.push_back({e, 0.0, {21913332.2010, 36001428.0925, -918579.3535}, -5.1545998223773e-04});
    cases.push_back(
        {e, 5400.7, {21897887.6967, 36000323.5995, -1088924.7672}, -5.1582253609327e-04});
  }
  {
    Ephemeris e;
    e.satellite = {System::kBeidou, 8};
    e.message = NavigationMessage::kBeidouD1;
    e.toe = GpsTime::from_week_and_tow(2111, 356414.0);
    e.toc = GpsTime::from_week_and_tow(2111, 356414.0);
    e.sqrt_a = std::sqrt(42169154.693444744);
    e.eccentricity = 0.00452617672272;
    e.m0 = 3.010135778569;
    e.delta_n = 1.314340461842e-09;
    e.omega0 = 2.65151254278;
    e.omega_dot = -2.904406694483e-09;
    e.i0 = 1.034957106918;
    e.i_dot = -2.500104139373e-11;
    e.omega = -2.750474409945;
    e.cuc = -9.807292371988e-06;
    e.cus = -9.116251021624e-06;
    e.crc = 551.046875;
    e.crs = -310.484375;
    e.cic = -3.469176590443e-07;
    e.cis = -3.497116267681e-07;
    e.af0 = -0.000332725350745;
    e.af1 = -2.407674060123e-11;
    e.af2 = 0.0;
    cases.push_back(
        {e, -7200.0, {-23798727.4438, 33724380.2437, -9347722.9172}, -3.3255993883909e-04});
    cases.push_back({e, 0.0, {-14542657.6507, 38659449.7238, 9392466.6158}, -3.3272705476125e-04});
    cases.push_back(
        {e, 5400.7, {-7234991.4333, 35416978.1209, 22070403.0486}, -3.3285201061693e-04});
  }
  {
    Ephemeris e;
    e.satellite = {System::kBeidou, 29};
    e.message = NavigationMessage::kBeidouD1;
    e.toe = GpsTime::from_week_and_tow(2111, 338414.0);
    e.toc = GpsTime::from_week_and_tow(2111, 338414.0);
    e.sqrt_a = std::sqrt(27906065.46853196);
    e.eccentricity = 0.0002908757887781;
    e.m0 = 0.981440975676;
    e.delta_n = 3.939092650449e-09;
    e.omega0 = 1.841638239945;
    e.omega_dot = -7.19065666257e-09;
    e.i0 = 0.9650502133007;
    e.i_dot = 3.503717372464e-10;
    e.omega = 1.456464983773;
    e.cuc = 5.093868821859e-06;
    e.cus = 1.699198037386e-06;
    e.crc = 327.390625;
    e.crs = 102.859375;
    e.cic = 8.381903171539e-09;
    e.cis = -1.396983861923e-08;
    e.af0 = 0.0002469952451065;
    e.af1 = 5.220712750997e-12;
    e.af2 = 0.0;
    cases.push_back(
        {e, -7200.0, {-7803734.6754, -14054432.9467, 22800297.2425}, 2.4695765167062e-04});
    cases.push_back({e, 0.0, {6470702.9302, -22729181.5227, 14832681.1310}, 2.4699467750713e-04});
    cases.push_back({e, 5400.7, {9549603.8400, -26214761.2916, -650156.5571}, 2.4702276484232e-04});
  }
  {
    Ephemeris e;
    e.satellite = {System::kGalileo, 1};
    e.message = NavigationMessage::kGalileoFnav;
    e.toe = GpsTime::from_week_and_tow(2111, 343800.0);
    e.toc = GpsTime::from_week_and_tow(2111, 343800.0);
    e.sqrt_a = std::sqrt(29600150.529687464);
    e.eccentricity = 9.650341235101e-05;
    e.m0 = -1.832282909549;
    e.delta_n = 2.65653922695e-09;
    e.omega0 = 0.2123282284601;
    e.omega_dot = -5.216288707934e-09;
    e.i0 = 0.982829647737;
    e.i_dot = -6.996720012901e-10;
    e.omega = -2.778709093141;
    e.cuc = 8.568167686462e-07;
    e.cus = 1.049041748047e-05;
    e.crc = 129.875;
    e.crs = 18.65625;
    e.cic = 1.862645149231e-09;
    e.cis = -1.4528632164e-07;
    e.af0 = -0.0008846927667037;
    e.af1 = -7.972289495228e-12;
    e.af2 = 0.0;
    cases.push_back(
        {e, -7200.0, {6393445.9691, 23144500.1571, 17314176.6930}, -8.8463527181894e-04});
    cases.push_back({e, 0.0, {-7310640.9202, 14910382.0048, 24503875.7749}, -8.8469254137504e-04});
    cases.push_back(
        {e, 5400.7, {-19076020.6873, 14144021.4550, 17667840.3170}, -8.8473560852936e-04});
  }
  {
    Ephemeris e;
    e.satellite = {System::kGalileo, 18};
    e.message = NavigationMessage::kGalileoInav;
    e.toe = GpsTime::from_week_and_tow(2111, 346200.0);
    e.toc = GpsTime::from_week_and_tow(2111, 346200.0);
    e.sqrt_a = std::sqrt(27977043.001687143);
    e.eccentricity = 0.167024361901;
    e.m0 = -0.7059615039589;
    e.delta_n = 6.776353690902e-09;
    e.omega0 = 1.596825902368;
    e.omega_dot = -1.157262490342e-08;
    e.i0 = 0.8823445068818;
    e.i_dot = 8.353919402846e-10;
    e.omega = 1.737784485905;
    e.cuc = 2.874061465263e-06;
    e.cus = 7.621943950653e-06;
    e.crc = 219.84375;
    e.crs = 52.5;
    e.cic = -2.648681402206e-06;
    e.cis = -1.713633537292e-07;
    e.af0 = -0.001163002045359;
    e.af1 = -1.422506556992e-11;
    e.af2 = 0.0;
    cases.push_back(
        {e, -7200.0, {-7687018.7431, 27584857.5777, -5778969.0818}, -1.1625211053444e-03});
    cases.push_back({e, 0.0, {-9490555.2116, 18580730.1962, 13443985.8609}, -1.1627126430415e-03});
    cases.push_back(
        {e, 5400.7, {-15003090.4893, 2616507.4828, 17641351.9754}, -1.1630895749875e-03});
  }
  {
    Ephemeris e;
    e.satellite = {System::kGalileo, 24};
    e.message = NavigationMessage::kGalileoInav;
    e.toe = GpsTime::from_week_and_tow(2111, 343800.0);
    e.toc = GpsTime::from_week_and_tow(2111, 343800.0);
    e.sqrt_a = std::sqrt(29600187.493018676);
    e.eccentricity = 0.0003798702964559;
    e.m0 = -0.7777171061706;
    e.delta_n = 2.64546733719e-09;
    e.omega0 = 0.2148517738502;
    e.omega_dot = -5.276291207279e-09;
    e.i0 = 0.9803637398563;
    e.i_dot = -5.485942797252e-10;
    e.omega = 0.8825152074779;
    e.cuc = 1.415610313416e-06;
    e.cus = 1.065246760845e-05;
    e.crc = 121.125;
    e.crs = 30.21875;
    e.cic = -5.587935447693e-09;
    e.cis = 6.332993507385e-08;
    e.af0 = 0.005385076918174;
    e.af1 = -1.988098574657e-11;
    e.af2 = 0.0;
    cases.push_back(
        {e, -7200.0, {22905909.2018, 6876977.1304, -17443112.6859}, 5.3852209748970e-03});
    cases.push_back({e, 0.0, {27837823.5571, 9706386.4653, 2558518.5608}, 5.3850775626118e-03});
    cases.push_back({e, 5400.7, {22349775.1657, 8979791.0430, 17186107.9064}, 5.3849696460929e-03});
  }
  {
    Ephemeris e;
    e.satellite = {System::kGps, 5};
    e.message = NavigationMessage::kGpsLnav;
    e.toe = GpsTime::from_week_and_tow(2111, 338400.0);
    e.toc = GpsTime::from_week_and_tow(2111, 338400.0);
    e.sqrt_a = std::sqrt(26560544.803125113);
    e.eccentricity = 0.00596827105619;
    e.m0 = 0.4148534136127;
    e.delta_n = 4.636264547599e-09;
    e.omega0 = -2.702534464528;
    e.omega_dot = -8.164268645988e-09;
    e.i0 = 0.9531595595615;
    e.i_dot = -1.071473202588e-10;
    e.omega = 0.8075427595916;
    e.cuc = -5.520880222321e-06;
    e.cus = 9.709969162941e-06;
    e.crc = 185.4375;
    e.crs = -111.0;
    e.cic = 7.450580596924e-09;
    e.cis = 4.470348358154e-08;
    e.af0 = -1.531280577183e-05;
    e.af1 = -7.958078640513e-13;
    e.af2 = 0.0;
    cases.push_back(
        {e, -7200.0, {-1419954.2962, -26156574.2859, 3541685.0288}, -1.5298927327268e-05});
    cases.push_back({e, 0.0, {5676756.8902, -15949954.7920, 20276768.9652}, -1.5318343951565e-05});
    cases.push_back(
        {e, 5400.7, {16761270.3789, -6569758.4734, 19451867.1763}, -1.5329880441116e-05});
  }
  {
    Ephemeris e;
    e.satellite = {System::kGps, 24};
    e.message = NavigationMessage::kGpsLnav;
    e.toe = GpsTime::from_week_and_tow(2111, 352800.0);
    e.toc = GpsTime::from_week_and_tow(2111, 352800.0);
    e.sqrt_a = std::sqrt(26560008.782028664);
    e.eccentricity = 0.009717508684844;
    e.m0 = -0.1778143775626;
    e.delta_n = 5.590590013371e-09;
    e.omega0 = -0.6378771604984;
    e.omega_dot = -8.677861467762e-09;
    e.i0 = 0.9362350368958;
    e.i_dot = -3.671581507536e-10;
    e.omega = 0.6665803446727;
    e.cuc = -1.881271600723e-07;
    e.cus = 5.366280674934e-06;
    e.crc = 259.53125;
    e.crs = -3.59375;
    e.cic = -1.862645149231e-09;
    e.cis = 1.098960638046e-07;
    e.af0 = -1.478521153331e-05;
    e.af1 = -5.684341886081e-13;
    e.af2 = 0.0;
    cases.push_back(
        {e, -7200.0, {11261978.0768, -20920406.2730, -11681699.6716}, -1.4760095560137e-05});
    cases.push_back({e, 0.0, {14599957.0371, -19524345.7886, 9882184.2978}, -1.4781238012605e-05});
    cases.push_back(
        {e, 5400.7, {14573455.8170, -8168652.7773, 20375491.5134}, -1.4801128793653e-05});
  }
  return cases;
}

}  // namespace leonav::test
