//! Wheels on wet roads: water met and thrown, spray, hydroplaning, the swept source in the wave field.
