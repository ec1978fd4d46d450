#include "include/pleuel.h"

int main(int argc, char** argv) {
  return pleuel_main(argc, argv);
}
