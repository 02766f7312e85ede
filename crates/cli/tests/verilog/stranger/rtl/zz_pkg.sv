// What the modules share. The file's name puts it behind its users.
package shot_pkg;
    localparam [8:0] SHOTS = 9'd300;
    typedef enum logic [1:0] {CLEARING, SHOOTING, WAITING, SOLVING} phase_t;
endpackage
