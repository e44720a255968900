// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <petzval/base/error.h>
#include <petzval/base/units.h>
#include <petzval/render/transform.h>

#include <Eigen/Dense>
#include <cmath>

namespace petzval::render {

namespace {

using Matrix = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

/// Reciprocal condition number below which a matrix counts as singular: doubles have 16 digits.
constexpr double singular = 1e-14;

Eigen::Map<const Matrix> eigen(const Matrix4& m) {
  return Eigen::Map<const Matrix>(m[0].data());
}

Matrix4 plain(const Matrix& m) {
  Matrix4 result;
  Eigen::Map<Matrix>(result[0].data()) = m;
  return result;
}

/// Rows and columns are brought to a common size before the condition is judged: a scene in µm is not
/// singular.
bool can_be_inverted(const Matrix& m) {
  const Eigen::Matrix3d upper = m.topLeftCorner<3, 3>();
  Eigen::Matrix3d scaled = upper;
  for (int i = 0; i < 3; ++i) {
    const double size = scaled.row(i).cwiseAbs().maxCoeff();
    if (!(size > 0)) return false;
    scaled.row(i) /= size;
  }
  for (int i = 0; i < 3; ++i) {
    const double size = scaled.col(i).cwiseAbs().maxCoeff();
    if (!(size > 0)) return false;
    scaled.col(i) /= size;
  }
  return std::abs(scaled.determinant()) > singular && m.fullPivLu().isInvertible();
}

}  // namespace

Transform::Transform(const Matrix4& matrix) : matrix_(matrix) {
  const Matrix m = eigen(matrix);
  if (!m.allFinite()) throw InputError("the matrix holds a number that is not finite");
  if (!can_be_inverted(m))
    throw InputError("the transformation is singular: it flattens space; scales other than 0 would be right");
  inverse_ = plain(m.inverse());
}

Transform Transform::translation(Vector3 by) {
  Matrix4 m = identity, inverse = identity;
  m[0][3] = by.x, m[1][3] = by.y, m[2][3] = by.z;
  inverse[0][3] = -by.x, inverse[1][3] = -by.y, inverse[2][3] = -by.z;
  return {m, inverse};
}

Transform Transform::scaling(Vector3 by) {
  Matrix4 m = identity;
  m[0][0] = by.x, m[1][1] = by.y, m[2][2] = by.z;
  return Transform(m);
}

Transform Transform::rotation(double degrees, Vector3 axis) {
  if (!(length(axis) > 0)) throw InputError("the axis of a rotation has no length");
  const Vector3 a = normalised(axis);
  const Eigen::AngleAxisd turn(radians(degrees), Eigen::Vector3d(a.x, a.y, a.z));
  Matrix m = Matrix::Identity();
  m.topLeftCorner<3, 3>() = turn.toRotationMatrix();
  return {plain(m), plain(m.transpose())};
}

Transform Transform::look_at(Vector3 eye, Vector3 target, Vector3 up) {
  const Vector3 forward = normalised(target - eye), right = normalised(cross(normalised(up), forward));
  if (!(length(forward) > 0) || !(length(right) > 1e-9))
    throw InputError("LookAt sees nothing: the eye is at the target, or up points along the view");
  const Vector3 above = cross(forward, right);
  const Matrix4 world_from_camera{{{right.x, above.x, forward.x, eye.x},
                                   {right.y, above.y, forward.y, eye.y},
                                   {right.z, above.z, forward.z, eye.z},
                                   {0, 0, 0, 1}}};
  return Transform(world_from_camera).inverse();
}

Transform Transform::between(const Transform& a, const Transform& b, double share) {
  if (share <= 0 || a.matrix_ == b.matrix_) return a;
  if (share >= 1) return b;
  if (!a.is_affine() || !b.is_affine())
    throw InputError(
        "a projection that moves is not known; translations, rotations and scales would be right");
  const Eigen::Affine3d from(eigen(a.matrix_)), to(eigen(b.matrix_));
  Eigen::Matrix3d turned_from, turned_to, scaled_from, scaled_to;
  from.computeRotationScaling(&turned_from, &scaled_from);
  to.computeRotationScaling(&turned_to, &scaled_to);
  const Eigen::Quaterniond turn = Eigen::Quaterniond(turned_from).slerp(share, Eigen::Quaterniond(turned_to));
  Matrix m = Matrix::Identity();
  m.topLeftCorner<3, 3>() = turn.toRotationMatrix() * ((1 - share) * scaled_from + share * scaled_to);
  m.topRightCorner<3, 1>() = (1 - share) * from.translation() + share * to.translation();
  return Transform(plain(m));
}

Transform Transform::inverse() const {
  return {inverse_, matrix_};
}

Transform operator*(const Transform& a, const Transform& b) {
  return {plain(eigen(a.matrix_) * eigen(b.matrix_)), plain(eigen(b.inverse_) * eigen(a.inverse_))};
}

bool Transform::swaps_handedness() const {
  return eigen(matrix_).topLeftCorner<3, 3>().determinant() < 0;
}

bool Transform::is_affine() const {
  return matrix_[3][0] == 0 && matrix_[3][1] == 0 && matrix_[3][2] == 0 && matrix_[3][3] == 1;
}

}  // namespace petzval::render
