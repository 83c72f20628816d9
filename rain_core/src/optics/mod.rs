//! Light at a water surface and in a drop: Fresnel, refraction, energy split, radiance.
