//! Files that others read: VTI and PVD for ParaView, CSV for probes.
