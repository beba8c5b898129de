// A loop that will not end while anybody waits.
Point(1) = {0, 0, 0};
For i In {1:1e15}
  x = Sqrt(i);
EndFor
