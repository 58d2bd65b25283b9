"""From constraints on a posture to a posture: ordered inverse-kinematics problems on NLopt."""
