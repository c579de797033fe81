// From wavelengths to linear sRGB.
#pragma once

#include <functional>
#include <vector>

#include "base/spectrum.h"
#include "base/vec.h"

namespace keyhole {

// CIE 1931 2-degree colour matching functions x, y, z at a wavelength in nm: the multi-lobe fit of [Wyman, Sloan and
// Shirley 2013, Simple Analytic Approximations to the CIE XYZ Color Matching Functions, JCGT 2(2), section 2.2].
Vec3 cie_xyz(double nanometres);

// Relative spectral power of CIE illuminant D65 (100 at 560 nm), linear between its values at 10 nm; 0 outside 300-830.
double cie_d65(double nanometres);

// Linear sRGB (Rec. 709 primaries, D65 white) of XYZ.
Spectrum xyz_to_rgb(const Vec3& xyz);

// A function of wavelength by (nm, value) knots, linear between them and constant beyond the first and last.
struct SampledSpectrum {
    std::vector<double> wavelengths, values;  // wavelengths increase
    double operator()(double nanometres) const;
};

// The colour of a reflectance, transmittance or index of refraction: seen under D65, scaled so that the constant
// function 1 is exactly (1, 1, 1). May leave [0, 1] for saturated spectra.
Spectrum reflected_rgb(const std::function<double(double)>& spectrum);

// The colour of emitted light, per nm, such that its luminance is the mean over the luminous efficiency y.
Spectrum emitted_rgb(const std::function<double(double)>& spectrum);

// Planck's law: radiance in W / (m^2 sr nm) of a black body at a temperature in kelvin.
double planck(double nanometres, double kelvin);

}  // namespace keyhole
