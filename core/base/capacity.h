// This header holds the capacities of data that enter from outside. The wire types in lcmtypes/
// carry the same limits: a message that claims more is rejected before it is decoded.
#pragma once
#include <cstddef>

namespace leonav {

inline constexpr std::size_t kMaxSignals = 6;         // signals used of a satellite: one a band
inline constexpr std::size_t kMaxObservations = 512;  // signals in one raw epoch, all satellites
// Satellites in one raw epoch. The table is as large as that of the observations, so that no
// satellite can go missing unreported.
inline constexpr std::size_t kMaxSatellites = kMaxObservations;
inline constexpr std::size_t kMaxMeasurements = 512;         // code, carrier, Doppler in one epoch
inline constexpr std::size_t kMaxEphemerisSatellites = 575;  // every satellite that has a name
// Sets of broadcast elements kept for one satellite. A server may send those of the next hour
// ahead: Galileo has a set of each of its two messages every ten minutes, and the set in force must
// stay.
inline constexpr std::size_t kMaxEphemeridesPerSatellite = 16;
// Of all satellites together: what 256 satellites may keep, and seven for each that has a name.
// Beyond that a satellite with most loses the set that arrived first and is not in use; the same
// holds for the other capacities of all satellites together.
inline constexpr std::size_t kMaxEphemerides = 4096;
inline constexpr std::size_t kMaxOrbitNodes = 32;        // precise states kept per satellite
inline constexpr std::size_t kMaxClockNodes = 64;        // precise clocks kept per satellite
inline constexpr std::size_t kMaxCorrectedStates = 128;  // corrected states of one message
inline constexpr std::size_t kMaxBiases = 2048;          // signal biases of one message
inline constexpr std::size_t kMaxSignalBiases = 24;      // signal biases kept per satellite
// Of all satellites together: twelve for each that has a name, six of those against the broadcast
// clock. A product has up to twelve a satellite, of which some 130 are not in low orbits.
inline constexpr std::size_t kMaxProductBiases = 12 * kMaxEphemerisSatellites;
inline constexpr std::size_t kMaxBroadcastBiases = 6 * kMaxEphemerisSatellites;
inline constexpr std::size_t kMaxImuBlock = 1536;    // IMU samples between two epochs: 500 Hz, 3 s
inline constexpr std::size_t kMaxImuHistory = 4096;  // IMU samples kept for re-propagation
// Raw epochs that wait for an IMU which is late: 2 s at 20 Hz.
inline constexpr std::size_t kMaxPendingEpochs = 40;
// Carrier arcs with an ambiguity in the filter: every satellite in view of four systems.
inline constexpr std::size_t kMaxArcs = 64;
// Fault hypotheses of one epoch: of each of those carriers a fault and a missed slip, and some of
// systems and sensors.
inline constexpr std::size_t kMaxFaultHypotheses = 2 * kMaxArcs + 16;

// Odometer increments between two epochs: 100 Hz, 3 s.
inline constexpr std::size_t kMaxOdometerBlock = 320;
inline constexpr std::size_t kMaxSpeedHistory = 2048;  // speeds kept: 500 Hz, 4 s

// Instants between two keyframes at which motion constraints act: 3 s, ten times a second.
inline constexpr std::size_t kMaxConstraintInstants = 32;
// Components of all constraints between two keyframes.
inline constexpr std::size_t kMaxConstraintReports = 8 * kMaxConstraintInstants;

inline constexpr std::size_t kMaxWindow = 60;  // the smoother's keyframes

inline constexpr std::size_t kMaxSystemTimes = 4;     // GPS, Galileo, BeiDou, LEO
inline constexpr std::size_t kMaxMailboxEpochs = 64;  // epochs under way at once

// Values of one antenna pattern: a receiver antenna has a grid of azimuth and zenith angle every 5
// degrees; a satellite has nadir angles alone, every degree up to 40 or every two up to 80.
inline constexpr std::size_t kMaxAntennaValues = 73 * 19;
inline constexpr std::size_t kMaxNadirValues = 41;
inline constexpr std::size_t kMaxSatelliteAntennaBands = 8;
inline constexpr std::size_t kMaxReceiverAntennaBands = 24;  // all systems together
inline constexpr std::size_t kMaxAntennaIntervals = 2;       // validity intervals kept at once
// Patterns of all satellites together: four for each that has a name. The IGS' file has some three
// to eight bands of each of some 130 satellites.
inline constexpr std::size_t kMaxSatelliteAntennas = 4 * kMaxEphemerisSatellites;

}  // namespace leonav
