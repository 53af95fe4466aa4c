/* puck-tables 0.1.0: stop, state, resultants of flat pucks that slide and spin under dry friction.
JavaScript; error 1e-06 (see each function);
pressure hertz, k/r = 0.632456, 0 <= delta <= 0.8.
Functions: stop, state, turn, resultants; self_test returns how many numbers of its vectors are
missed: 0.  Needs IEEE arithmetic (no -ffast-math).  Made by a program: do not edit.

MIT License

Copyright (c) 2026 The puck-tables authors

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in all
copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE
SOFTWARE. */
(function () {
"use strict";

const STOP_QUANTUM = 8.7e-09;
const CONSTANTS_QUANTUM = 2e-09;
const TALLEST = 0.8000000000000002;
const STEEP = 3.1249999999999987;
const SPIN_TIME = 0.6790620954271842;
const LONGEST = 4.0;
const TOLERANCE = 1e-06;
const LARGEST = 8e+307;
const SMALLEST = 1e-300;
const TURN_SHARE = 0.001;
const HALF_PI = 1.5707963267948966;
const PATCH_QUANTUM = 2.9e-09;
const REACH = 16.0;
const END = 0.6264;
const STOP_CASES = new Float64Array([
2,0,30,0,.98,.04,2.3163174,2.1937982,0,2.1937982,42.097635,1,0,5,.8,1,1,3.6399205,1.9899365,
-.25136136,2.0217504,8.9462064,1,0,1,.4,1,1,1.2986721,.61032561,-.033526035,.61227459,.72059545,
.3,-.4,-.7,.8,2.5,.6,.25230534,.039581897,-.042899311,.058736141,-.10312095,-1.5,.2,.02,.4,3,.1,
.50442686,-.37831426,.050476403,.38166681,.006839664,.01,.02,-6,.8,1,.5,2.0374256,.008668423,
.024551631,.026239233,-6.1120201,1,1,0,.4,.5,2,2.8284271,1.4142136,1.4142136,2,0,0,0,-3,.4,1,
.25,.50929657,0,0,0,-.76394486,1,0,1.5313894,0,1,1,1.5325797,.75051814,0,.75051814,1.1974246,0,
-1,2,0,1,1,1.7768854,0,-.89538042,.89538042,1.7679892,3e-7,4e-7,.08,.8,9.81,1e-5,8.2194639e-8,
1.3977543e-14,1.4496715e-14,2.0293447e-14,3.3274397e-9,200000,-100000,900,0,.1,300,3082978,
295060270000,-147530130000,329887410000,1473278500]);
const STATE_CASES = new Float64Array([
2,0,30,0,.98,.04,0,0,0,0,2,0,30,1,0,5,.8,1,1,.364,.34954108,-.0040508884,1.7263741,.92013002,
-.022028152,4.4857557,1,0,1,.4,1,1,.6493,.46919505,-.013794439,.52173057,.45603512,-.03624193,
.58222603,.3,-.4,-.7,.8,2.5,.6,.2271,.039112194,-.042775809,-.10179998,.036589966,-.014637604,
-.10331434,-1.5,.2,.02,.4,3,.1,.4994,-.37827673,.050471261,.0068320321,-.01493853,.0020310196,
.0022399973,.01,.02,-6,.8,1,.5,0,0,0,0,.01,.02,-6,1,1,0,.4,.5,2,.2828,.26866214,.26866214,0,
.9000151,.9000151,0,0,0,-3,.4,1,.25,.2546,0,0,-.57288621,0,0,-1.5002844,1,0,1.5313894,0,1,1,
1.379,.74339296,0,1.1848008,.093388863,0,.1635549,0,-1,2,0,1,1,1.759,0,-.89528684,1.7678138,
6.4007509e-19,-.01045322,.019626155,3e-7,4e-7,.08,.8,9.81,1e-5,0,0,0,0,3e-7,4e-7,.08,200000,
-100000,900,0,.1,300,308300,58243520000,-29121760000,265875760,177901.26,-88950.631,824.29474,1,
0,5,.8,1,1,5.46,1.9899365,-.25136136,8.9462064,-0,-0,0]);
const TURN_CASES = new Float64Array([
2,0,30,0,.98,.04,0,1,0,5,.8,1,1,-1.633802,1,0,1,.4,1,1,-.87787827]);
const RESULTANTS_CASES = new Float64Array([
-.7853981633974483,0,1.2495608,0,.62478041,-.7853981633974483,.8,1.2411497,.3231025,.55749104,
-.3,0,1.0366298,0,.42163349,-.3,.8,1.0365751,.215512,.34099071,0,0,1,0,.4,0,.8,1,.2,.32,.8,0,
1.2550042,0,.64113324,.8,.8,1.2452492,.32699638,.57617582,1.4,0,1.186601,0,1.160325,1.4,.8,
1.0969804,.32301749,1.1601615]);
const BORDERS = new Float64Array([
-.5,0,.5]);
const ORIGINS = new Float64Array([
-1,0,0,1]);
const SCALES = new Float64Array([
2,-2,2,-2]);
const RATE_UNITS = new Float64Array([
.9,.396,.948]);
const PATCH = new Float64Array([
2873565,574713,574715,2873563,574713,574712,2873563,574713,574713,2873563,574713,574713,2873563,
574713,574713,2873563,574713,574713,2873565,574713,574713,2873581,574717,574718,2873661,574734,
574741,2873948,574795,574822,2874800,574978,575066,2877028,575455,575703,2882372,576601,577234,
2894477,579198,580714,2920994,584900,588406,2978182,597249,605314,3101087,624069,643330,3363323,
682747,733157,3590547,748008,897502,3590727,748074,897716,3590669,748052,897644,3590727,748074,
897716,3590553,748009,897500,3589109,747468,895698,3584564,745800,890237,3573954,742094,878608,
3552629,735188,858500,3514059,723772,828572,3450976,706685,789136,3358651,683527,742509,3239724,
655443,692932,3107852,625639,645984,2986266,598961,607501,2899684,580297,582095,2862661,572394,
571701,3590766,748089,897766,3590673,748054,897650,3590704,748066,897689,3590673,748054,897650,
3590767,748089,897766,3591545,748381,898741,3593912,749280,901770,3598963,751275,908689,3607586,
754983,922313,3619717,761108,946929,3633345,770306,988492,3643729,782875,1053522,3643704,798258,
1145846,3625895,814655,1262035,3586629,829286,1389089,3529679,839620,1508039,3466871,844859,
1602282,3414028,846354,1664096,3383668,846238,1693759,3385338,846334,1692669,3385337,846334,
1692668,3385337,846334,1692668,3385337,846334,1692668,3385337,846334,1692668,3385337,846334,
1692668,3385337,846334,1692668,3385339,846334,1692666,3385351,846334,1692655,3385390,846334,
1692615,3385505,846334,1692501,3385797,846334,1692208,3386471,846334,1691533,3387913,846333,
1690083,3390836,846327,1687129,3396523,846305,1681305,3407269,846217,1670035,3427094,845892,
1648259,3462825,844727,1605534,3524639,840551,1518669,3621347,825820,1333572]);
const PATCH_ROWS = new Float64Array([
0,18,35,54,75]);
const STOP = new Float64Array([
4789272,2394636,-412868,2394636,3302947,0,0,-14237,0,113895,0,0,-492,0,3932,0,0,-17,0,136,
4789272,2394636,-412868,2394636,3302947,0,0,-14237,0,113895,0,0,-492,0,3932,0,0,-17,0,136,
4789272,2394636,-412868,2394636,3302947,0,0,-14237,0,113895,0,0,-492,0,3932,0,0,-17,0,136,
4789272,2394636,-412868,2394636,3302947,0,0,-14237,0,113895,0,0,-492,0,3932,0,0,-17,0,136,
4789272,2394636,-412868,2394636,3302947,0,0,-14237,0,113895,0,0,-492,0,3932,0,0,-17,0,136,
4789273,2394636,-412868,2394636,3302947,2,0,-14237,0,113895,1,0,-492,0,3932,0,0,-17,0,136,
4789285,2394635,-412868,2394635,3302946,12,0,-14237,0,113895,5,0,-492,0,3932,1,0,-17,0,136,
4789332,2394633,-412869,2394633,3302941,50,0,-14237,0,113894,18,0,-492,0,3932,3,0,-17,0,136,
4789476,2394621,-412871,2394622,3302921,154,0,-14238,1,113893,46,0,-492,0,3932,7,0,-17,0,135,
4789832,2394585,-412876,2394587,3302856,389,1,-14239,4,113890,100,0,-492,0,3930,13,0,-17,0,135,
4790588,2394487,-412891,2394495,3302684,853,4,-14242,13,113880,189,0,-492,1,3927,20,0,-17,0,134,
4792025,2394256,-412924,2394276,3302269,1685,9,-14249,32,113853,323,0,-493,4,3919,28,0,-17,0,
131,4794515,2393749,-412993,2393795,3301353,3066,22,-14260,75,113789,507,1,-493,8,3900,34,0,-16,
1,126,4798501,2392709,-413127,2392809,3299457,5219,48,-14276,162,113649,743,2,-491,17,3863,37,0,
-15,2,118,4804417,2390679,-413370,2390885,3295712,8412,99,-14296,332,113357,1022,4,-486,35,3793,
36,0,-13,3,105,4812497,2386862,-413790,2387263,3288564,12946,197,-14312,651,112777,1325,8,-473,
65,3669,28,0,-10,5,86,4822371,2379881,-414479,2380636,3275261,19132,381,-14302,1230,111669,1619,
16,-447,116,3464,12,1,-6,7,60,4832202,2367391,-415551,2368770,3250919,27236,722,-14222,2259,
109612,1853,30,-400,196,3140,-10,1,0,10,30,4837007,2345469,-417110,2347916,3206923,37356,1349,
-13976,4046,105896,1957,55,-323,314,2660,-34,2,5,12,-1,4825368,2307861,-419124,2312077,3128222,
49142,2496,-13383,7076,99358,1846,93,-209,464,1998,-54,2,9,9,-25,4774277,2245679,-421026,
2252674,2989680,61286,4572,-12105,12034,88235,1445,141,-64,609,1180,-59,1,8,1,-32,4432456,
2072932,-404585,2086286,2466282,69089,12122,-6313,25779,52000,298,49,61,346,131,-15,-4,0,-10,-5,
4432456,2072932,-404585,2086286,2466283,69089,12122,-6313,25779,52000,298,49,61,346,131,-15,-4,
0,-10,-5,4432456,2072932,-404585,2086286,2466283,69089,12122,-6313,25779,52000,298,49,61,346,
131,-15,-4,0,-10,-5,4432456,2072932,-404585,2086286,2466283,69089,12122,-6313,25779,52000,298,
49,61,346,131,-15,-4,0,-10,-5,4432823,2073049,-404620,2086400,2466770,69093,12116,-6318,25770,
52030,298,50,62,347,131,-15,-4,0,-10,-5,4434290,2073518,-404759,2086854,2468718,69111,12092,
-6338,25733,52149,301,50,62,349,132,-15,-4,0,-10,-5,4437948,2074692,-405105,2087995,2473586,
69154,12033,-6390,25642,52448,308,53,62,353,136,-15,-4,0,-10,-5,4445227,2077057,-405784,2090290,
2483304,69234,11913,-6492,25458,53045,321,57,63,362,143,-16,-4,0,-10,-5,4457831,2081250,-406929,
2094357,2500244,69360,11701,-6673,25129,54094,345,64,64,378,156,-17,-4,0,-10,-5,4477625,2088105,
-408641,2101002,2527126,69516,11358,-6963,24590,55775,385,74,65,403,179,-19,-4,0,-11,-6,4506407,
2098708,-410933,2111269,2566825,69647,10834,-7399,23751,58302,449,90,65,438,218,-22,-4,0,-11,-8,
4545532,2114435,-413663,2126475,2622017,69614,10077,-8016,22499,61903,545,109,63,484,283,-26,-4,
1,-11,-10,4595302,2136857,-416494,2148113,2694603,69143,9037,-8838,20708,66792,689,129,55,536,
392,-33,-4,2,-11,-13,4654131,2167399,-418928,2177524,2784884,67771,7697,-9859,18268,73107,892,
144,34,584,572,-41,-3,3,-9,-18,4717511,2206622,-420424,2215204,2890438,64790,6095,-11026,15140,
80804,1163,148,-10,607,862,-50,-1,6,-5,-25,4777282,2253177,-420585,2259817,3004929,59276,4349,
-12224,11435,89524,1489,132,-86,579,1305,-57,1,8,2,-29,4822069,2302830,-419338,2307277,3117440,
50249,2656,-13289,7478,98472,1812,97,-196,479,1925,-55,2,9,9,-26,4840485,2348497,-417037,
2350810,3213696,37079,1247,-14046,3807,106442,1994,52,-329,309,2692,-35,2,6,12,-2,4827261,
2381938,-414446,2382602,3279789,20123,313,-14370,1068,112068,1782,14,-453,113,3476,9,1,-5,9,53,
4432456,2072932,-404585,2086286,2466283,69089,12122,-6313,25779,52000,298,49,61,346,131,-15,-4,
0,-10,-5,4432456,2072932,-404585,2086286,2466283,69089,12122,-6313,25779,52000,298,49,61,346,
131,-15,-4,0,-10,-5,4432456,2072932,-404585,2086286,2466283,69089,12122,-6313,25779,52000,298,
49,61,346,131,-15,-4,0,-10,-5,4432456,2072932,-404585,2086286,2466283,69089,12122,-6313,25779,
52000,298,49,61,346,131,-15,-4,0,-10,-5,4432089,2072815,-404550,2086172,2465795,69085,12128,
-6307,25788,51970,297,49,61,346,130,-15,-4,0,-10,-5,4430621,2072347,-404410,2085718,2463846,
69067,12152,-6287,25824,51851,294,48,61,344,129,-14,-3,0,-10,-4,4426942,2071181,-404058,2084586,
2458971,69022,12211,-6236,25915,51553,288,46,61,339,125,-14,-3,0,-10,-4,4419547,2068863,-403342,
2082335,2449210,68927,12329,-6134,26094,50958,275,42,60,330,119,-14,-3,0,-9,-4,4406484,2064855,
-402052,2078440,2432107,68746,12534,-5956,26403,49920,253,35,59,313,107,-12,-3,0,-9,-4,4385269,
2058559,-399900,2072318,2404759,68416,12856,-5673,26884,48271,219,23,56,287,91,-11,-3,0,-8,-3,
4352773,2049350,-396505,2063351,2364012,67832,13327,-5258,27575,45830,171,4,52,246,69,-8,-2,0,
-7,-2,4305119,2036591,-391401,2050904,2306938,66822,13976,-4681,28502,42428,110,-23,46,186,44,
-5,-2,0,-6,-1,4237675,2019641,-384089,2034326,2231679,65112,14818,-3925,29668,37944,40,-60,36,
102,19,-2,-1,0,-3,-1,4145342,1997883,-374137,2012967,2138560,62294,15844,-2988,31028,32362,-27,
-108,23,-8,-3,1,1,0,0,0,4023494,1970864,-361340,1986320,2031170,57792,16992,-1889,32464,25843,
-68,-163,7,-144,-16,1,2,0,5,0,3870151,1938692,-345920,1954412,1916963,50876,18120,-666,33752,
18786,-50,-217,-11,-298,-19,-3,3,0,9,0,3689933,1902816,-328779,1918600,1806939,40804,18992,633,
34568,11841,62,-256,-30,-453,-14,-12,4,1,13,0,3499468,1867023,-311752,1882610,1713921,27288,
19357,1952,34607,5837,253,-267,-49,-590,-6,-22,3,1,16,0,3331926,1837953,-297747,1853143,1649612,
11450,19143,3185,33867,1588,381,-255,-61,-706,0,-17,2,1,18,0,3252213,1825878,-291729,1840793,
1626106,0,18841,3854,33209,0,0,-249,-51,-782,0,0,3,1,18,0,3252213,1825877,-291729,1840793,
1626107,0,18841,3854,33209,0,0,-249,-51,-782,0,0,3,1,18,0,3252213,1825878,-291729,1840793,
1626107,0,18841,3854,33209,0,0,-249,-51,-782,0,0,3,1,18,0,3252213,1825877,-291729,1840793,
1626107,0,18841,3854,33209,0,0,-249,-51,-782,0,0,3,1,18,0,3252213,1825878,-291729,1840793,
1626107,0,18841,3854,33209,0,0,-249,-51,-782,0,0,3,1,18,0,3252214,1825878,-291729,1840793,
1626107,0,18841,3854,33209,0,0,-249,-51,-782,0,0,3,1,18,0,3252223,1825879,-291730,1840795,
1626109,2,18841,3854,33209,0,0,-249,-51,-782,0,0,3,1,18,0,3252273,1825886,-291734,1840802,
1626124,10,18842,3853,33209,1,1,-249,-51,-782,0,0,3,1,18,0,3252475,1825916,-291749,1840833,
1626183,43,18842,3851,33211,5,3,-249,-51,-782,0,0,3,1,18,0,3253110,1826010,-291796,1840929,
1626370,145,18845,3846,33216,18,11,-249,-51,-781,0,1,3,1,18,0,3254820,1826265,-291923,1841189,
1626872,417,18851,3832,33230,52,29,-249,-51,-779,0,1,3,1,18,0,3258917,1826877,-292229,1841815,
1628088,1052,18865,3798,33262,133,66,-249,-52,-775,0,2,3,1,18,0,3267907,1828239,-292906,1843207,
1630797,2382,18897,3723,33332,316,128,-250,-53,-766,0,1,3,1,19,0,3286285,1831079,-294315,
1846106,1636506,4920,18958,3572,33471,699,211,-251,-55,-749,0,-2,3,1,19,0,3321681,1836718,
-297092,1851854,1648050,9354,19062,3287,33718,1472,293,-254,-57,-719,-1,-9,2,1,18,0,3386231,
1847435,-302316,1862750,1670803,16451,19206,2787,34096,2986,326,-259,-57,-669,-2,-18,2,1,17,0,
3497814,1866939,-311700,1882502,1714923,26814,19305,1969,34529,5891,256,-264,-49,-590,-6,-22,3,
1,16,0,3679219,1900585,-327727,1916380,1799893,40385,19067,703,34649,11397,70,-259,-31,-462,-13,
-14,3,1,13,0,3951880,1954672,-353506,1970407,1962278,55704,17800,-1221,33501,21680,-119,-204,-2,
-234,-23,3,4,0,8,0]);
const STOP_ROWS = new Float64Array([
0,21,40,59,78]);
const MOTION = new Float64Array([
5262233,22149,25,271,-41,1,4,0,0,0,5203708,-1900,-2,-23,4,0,0,0,0,0,5202953,-2212,-3,-27,4,0,0,
0,0,0,5264500,23079,26,282,-43,1,4,0,0,0,5391459,74910,-46,935,-147,1,14,0,-1,0,5585403,152757,
-547,1954,-321,1,29,0,-3,0,5846102,253967,-2082,3302,-585,-3,51,0,-4,0,6171123,373333,-5550,
4839,-961,-14,82,1,-7,0,6555364,503370,-12034,6314,-1480,-35,122,3,-10,0,6990350,635484,-22518,
7448,-2169,-67,175,6,-14,-1,7463122,761557,-37493,8051,-3050,-108,243,9,-19,-1,7955043,875205,
-56585,8096,-4132,-154,328,13,-24,-1,8441595,972333,-78361,7706,-5394,-201,424,17,-29,-2,
8894535,1051086,-100500,7080,-6775,-249,521,21,-33,-2,9287004,1111523,-120445,6409,-8155,-292,
604,25,-36,-2,9600172,1155193,-136276,5829,-9389,-330,662,29,-37,-3,9828196,1184687,-147324,
5396,-10350,-358,691,31,-37,-3,9978577,1203140,-154118,5113,-10993,-378,700,32,-37,-3,10067818,
1213724,-157824,4947,-11358,-390,699,33,-38,-3,10115131,1219224,-159629,4860,-11534,-396,697,34,
-38,-3,10137327,1221776,-160417,4819,-11606,-399,697,34,-39,-3,10146418,1222816,-160722,4803,
-11631,-400,697,34,-39,-3,10149610,1223180,-160826,4797,-11639,-400,697,34,-39,-3,10150546,
1223287,-160856,4795,-11641,-400,697,34,-39,-3,10150768,1223312,-160863,4795,-11642,-400,697,34,
-39,-3,10150809,1223317,-160865,4795,-11642,-400,697,34,-39,-3,10150815,1223318,-160865,4795,
-11642,-400,697,34,-39,-3,10150815,1223318,-160865,4795,-11642,-400,697,34,-39,-3,10150816,
1223318,-160865,4795,-11642,-400,697,34,-39,-3,-1732570,4782,72298,-547,-9963,29,1422,-4,-216,0,
32,0,-1785165,-408,76172,47,-10651,-2,1535,0,-235,0,36,0,-1785841,-481,76219,55,-10659,-3,1536,
0,-235,0,36,0,-1730612,5001,72171,-571,-9943,30,1419,-4,-215,1,32,0,-1618863,15257,64109,-1782,
-8536,83,1191,-10,-177,1,26,0,-1456835,28381,53067,-3433,-6689,131,905,-14,-131,1,19,0,-1259809,
41955,41097,-5342,-4841,154,641,-12,-93,1,14,0,-1048538,53971,30216,-7357,-3337,149,447,-7,-68,
0,11,0,-842237,63400,21443,-9373,-2268,126,323,1,-54,-2,9,0,-654218,70117,14859,-11308,-1562,99,
245,9,-45,-3,8,1,-491559,74522,10108,-13090,-1106,73,195,15,-38,-3,7,1,-356696,77195,6751,
-14660,-806,52,159,21,-33,-4,6,1,-249125,78689,4409,-15982,-598,36,129,25,-28,-4,5,1,-166629,
79452,2798,-17041,-444,25,102,28,-22,-5,4,1,-106035,79800,1711,-17845,-323,17,78,30,-17,-5,3,1,
-63683,79937,997,-18421,-226,11,57,31,-13,-5,2,1,-35754,79980,547,-18808,-149,8,38,32,-9,-5,2,1,
-18558,79988,279,-19048,-92,5,24,32,-5,-4,1,1,-8791,79986,130,-19185,-51,4,14,32,-3,-4,1,1,
-3744,79984,55,-19256,-26,3,7,32,-2,-4,0,1,-1408,79983,20,-19289,-11,3,3,32,-1,-4,0,1,-458,
79982,6,-19303,-4,3,1,32,0,-4,0,1,-125,79982,2,-19307,-1,3,0,32,0,-4,0,1,-28,79982,0,-19309,0,3,
0,32,0,-4,0,1,-5,79982,0,-19309,0,3,0,32,0,-4,0,1,-1,79982,0,-19309,0,3,0,32,0,-4,0,1,0,79982,0,
-19309,0,3,0,32,0,-4,0,1,0,79982,0,-19309,0,3,0,32,0,-4,0,1,0,79982,0,-19309,0,3,0,32,0,-4,0,1,
2350022,7036,39553,1524,-5648,-47,836,-2,-124,1,2320727,-579,39718,-125,-5538,4,821,0,-122,0,
2320106,-746,39720,-162,-5536,5,820,0,-122,0,2351872,7534,39547,1633,-5655,-50,837,-2,-124,1,
2415789,23422,39129,5065,-5903,-156,873,-6,-129,2,2506434,43922,38440,9484,-6280,-289,926,-11,
-136,3,2612955,64394,37665,13914,-6762,-411,994,-17,-145,5,2720965,80410,37239,17432,-7301,-488,
1068,-22,-155,6,2816360,90027,37506,19599,-7819,-514,1136,-24,-164,6,2889424,94333,38329,20596,
-8236,-515,1188,-24,-171,6,2937318,95720,39228,20922,-8512,-513,1223,-24,-176,6,2963638,96025,
39849,20994,-8663,-512,1243,-24,-178,6,2975397,96068,40155,21004,-8730,-512,1252,-24,-179,6,
2979484,96071,40264,21005,-8753,-512,1255,-24,-180,6,2980521,96071,40292,21005,-8759,-512,1255,
-24,-180,6,2980696,96071,40297,21005,-8760,-512,1256,-24,-180,6,2980712,96071,40297,21005,-8760,
-512,1256,-24,-180,6,2980713,96071,40297,21005,-8760,-512,1256,-24,-180,6,2980713,96071,40297,
21005,-8760,-512,1256,-24,-180,6,2980714,96071,40297,21005,-8760,-512,1256,-24,-180,6,1848629,
1559,31779,478,-4400,-7,650,-1,-97,0,1859206,-134,31763,-41,-4441,1,658,0,-98,0,1859336,-155,
31763,-48,-4441,1,658,0,-98,0,1848239,1622,31780,497,-4398,-7,650,-1,-97,0,1824960,5298,31815,
1628,-4309,-23,632,-4,-94,1,1788345,10937,31864,3374,-4167,-47,604,-9,-89,2,1737030,18553,31917,
5757,-3967,-77,564,-15,-83,3,1669447,28089,31956,8786,-3703,-111,513,-23,-74,4,1583888,39390,
31944,12451,-3366,-144,447,-33,-64,6,1478654,52171,31813,16717,-2949,-170,368,-46,-51,8,1352365,
65975,31449,21509,-2448,-181,276,-61,-36,11,1204530,80144,30672,26702,-1866,-166,174,-78,-20,13,
1036476,93820,29230,32102,-1222,-113,67,-98,-4,16,852652,106017,26827,37440,-564,-15,-32,-118,
12,18,661948,115818,23250,42384,27,128,-110,-136,24,19,477952,122688,18579,46601,448,299,-152,
-151,30,20,316490,126743,13377,49859,630,468,-155,-160,30,21,190117,128703,8541,52122,594,607,
-130,-164,26,21,102882,129471,4810,53541,440,703,-92,-165,18,21,49900,129719,2389,54346,271,760,
-56,-165,11,20,21551,129788,1046,54761,143,790,-30,-164,6,20,8201,129807,401,54953,65,804,-14,
-163,3,20,2707,129812,133,55031,25,810,-5,-163,1,20,758,129814,38,55059,8,812,-2,-162,0,20,175,
129814,9,55067,2,812,0,-162,0,20,32,129814,2,55069,0,813,0,-162,0,20,4,129814,0,55069,0,813,0,
-162,0,20,0,129814,0,55069,0,813,0,-162,0,20,0,129814,0,55069,0,813,0,-162,0,20,-1,129814,0,
55069,0,813,0,-162,0,20]);
const MOTION_ROWS = new Float64Array([
0,290,638,838]);
const MOTION_CELLS = new Float64Array([
25,25,16,26]);
const MOTION_POWERS = new Float64Array([
5,6,5,5]);
const MOTION_QUANTA = new Float64Array([
8e-9,6.7e-9,6.4e-9,8e-9]);
const CONSTANTS = new Float64Array([
143193280,-6099591,852218,-122687,18113,-2849,440,0,0,0,0,0,0,0,321596640,-3049796,426109,
-61343,9056,-1424,220,275000333,24999963,0,0,0,0,0,116627164,15936551,-662472,27538,-1145,48,-2,
271925879,44482446,0,0,0,0,0,0,0,0,0,0,0,0,112912620,-4693702,195114,-8111,337,-14,1,126346255,
-1019148,124110,-15520,1988,-269,36]);
function measured(vx, vy, spin, delta, decel, radius, m) {
	let none = vx - vx + (vy - vy) + (spin - spin) + (decel - decel) + (radius - radius);
	if (!(none == 0.0 && delta >= 0.0 && delta <= TALLEST && decel > 0.0 && radius > 0.0)) {
		return 1;
	}
	let edge = radius * spin;
	if (edge - edge != 0.0) return 2;
	let x = vx;
	let y = vy;
	let e = edge;
	let large = Math.abs(vx) + Math.abs(vy) + Math.abs(edge);
	if (large > 1e-100 && large < 1e+100) {
		large = 1.0;
	} else {
		large = Math.abs(vx) > Math.abs(vy) ? Math.abs(vx) : Math.abs(vy);
		large = Math.abs(edge) > large ? Math.abs(edge) : large;
		if (large == 0.0) {
			for (let n = 0; n < 7; n++) m[n] = 0.0;
			m[7] = 1.0;
			return 0;
		}
		x = vx / large;
		y = vy / large;
		e = edge / large;
	}
	let speed2 = x * x + y * y;
	let speed = Math.sqrt(speed2);
	let rim = Math.abs(e);
	let q = Math.sqrt(speed2 + e * e);
	let unit = 1.0 / q;
	m[0] = large * q;
	m[1] = speed * unit;
	m[2] = rim * unit;
	m[3] = x * unit;
	m[4] = y * unit;
	m[5] = rim > speed ? 1.0 : 0.0;
	m[6] = 2.0 * (rim < speed ? rim : speed) / (speed + rim);
	m[7] = edge < 0.0 ? -1.0 : 1.0;
	let size = LONGEST * (m[0] / decel) * m[0];
	return size < LARGEST && size < LARGEST * radius ? 0 : 2;
}
const look_up_w = new Float64Array(8);
const look_up_row = new Float64Array(70);
function look_up(table, first, cells, degree, powers, functions, quantum, xi, s, out_row) {
	const w = look_up_w;
	let p = xi * cells;
	let cell = Math.floor(p);
	cell = cell > cells - 1 ? cells - 1 : cell;
	let t = p - cell;
	w[0] = quantum;
	for (let d = 1; d < degree + 1; d++) {
		let saved = 0.0;
		for (let r = 0; r < d; r++) {
			let part = w[r];
			w[r] = saved + (r + 1 - t) * part;
			saved = (t + (d - 1 - r)) * part;
		}
		w[d] = saved;
	}
	let width = powers * functions;
	let here = first + cell * width;
	const row = look_up_row;
	for (let j = 0; j < width; j++) row[j] = w[0] * table[here + j];
	for (let n = 1; n < degree + 1; n++) {
		for (let j = 0; j < width; j++) row[j] += w[n] * table[here + n * width + j];
	}
	for (let f = 0; f < functions; f++) {
		let value = row[width - functions + f];
		for (let k = powers - 2; k > -1; k--) value = value * s + row[k * functions + f];
		out_row[f] = value;
	}
}
function look_up_near(table, rows, degree, powers, functions, quantum, c, s, out_row) {
	let side = 0;
	for (let n = 0; n < 4 - 1; n++) side += c >= BORDERS[n] ? 1 : 0;
	look_up(table, rows[side] * powers * functions, rows[side + 1] - rows[side] - degree, degree,
			powers, functions, quantum, Math.sqrt(Math.sqrt((c - ORIGINS[side]) * SCALES[side])), s,
			out_row);
}
function table_at(side, share, delta, f) {
	look_up_near(STOP, STOP_ROWS, 4, 4, 5, STOP_QUANTUM, side == 1 ? 1.0 - share : share - 1.0,
			STEEP * delta * delta - 1.0, f);
}
function stop_functions(side, share, delta, f) {
	table_at(side, share, delta, f);
	if (share == 0.0 && side == 0) {
		f[0] = 1.0;
		f[1] = 0.5;
		f[3] = 0.5;
	} else if (share == 0.0) {
		f[0] = SPIN_TIME;
		f[4] = 0.5 * SPIN_TIME;
	}
}
function stopped(m, f, delta, decel, radius, out) {
	let duration = m[0] / decel;
	let size = duration * m[0];
	let across = delta * m[7] * m[2] * f[2];
	out[0] = duration * f[0];
	out[1] = size * (f[1] * m[3] - across * m[4]);
	out[2] = size * (f[1] * m[4] + across * m[3]);
	out[3] = size * m[1] * f[3];
	out[4] = size / radius * m[7] * m[2] * f[4];
}
function refused(out, size, code) {
	for (let n = 0; n < size; n++) out[n] = NaN;
	return code;
}
/* Stop time s, place x m, y m, path length m and body angle rad of a launch, into out[5].

vx, vy m/s; spin rad/s, counter-clockwise positive; delta = 2 f h / r from 0 to TALLEST;
decel = f g m/s^2; radius m.  Errors: the tolerance times Q/J, Q^2/J, Q^2/J and Q^2/(J r), where
Q = hypot(v, r w) and J is decel.  Returns 0; 1 where a number is not finite or out of range, 2
where the motion is too large for floating point: nothing but NaN is in out then. */
const stop_m = new Float64Array(8);
const stop_f = new Float64Array(5);
function stop(vx, vy, spin, delta, decel, radius, out) {
	const m = stop_m;
	const f = stop_f;
	let code = measured(vx, vy, spin, delta, decel, radius, m);
	if (code != 0) return refused(out, 5, code);
	stop_functions(Math.floor(m[5]), m[6], delta, f);
	stopped(m, f, delta, decel, radius, out);
	return 0;
}
function constant(row, s) {
	let total = 0.0;
	for (let m = 7 - 1; m > -1; m--) total = total * s + CONSTANTS[row * 7 + m];
	return CONSTANTS_QUANTUM * total;
}
function limit_motion_at(branch, xi, s, out_row) {
	let powers = MOTION_POWERS[branch];
	look_up(MOTION, MOTION_ROWS[branch], MOTION_CELLS[branch], 4, powers > 1 ? powers : 1, 2,
			MOTION_QUANTA[branch], xi, s, out_row);
}
function heading_of(xi) {
	let x = END * xi;
	return REACH * x * x / (1.0 - x);
}
function error_of(branch, xi, s, wanted, f) {
	limit_motion_at(branch, xi, s, f);
	return branch == 1 || branch == 3 ? f[0] - wanted : Math.log(f[0] / wanted) - heading_of(xi);
}
function heading_at(end, theta, rate, delta, s, part) {
	let regular = part * RATE_UNITS[end] / rate;
	return delta / TALLEST * (constant(6 + end, s) * theta + regular);
}
const know_f = new Float64Array(2);
function know(delta, time, launch) {
	const f = know_f;
	let s = STEEP * delta * delta - 1.0;
	let c = launch[5] == 1.0 ? 1.0 - launch[6] : launch[6] - 1.0;
	let limit = constant(0, s);
	let fast = c > limit ? 1 : 0;
	let start = constant(1 + fast, s);
	let ahead = (fast == 1 ? c < start : c > start) ? 1 : 0;
	let branch = 2 * fast + ahead;
	let wanted = c - limit;
	if (ahead == 0) {
		wanted = launch[5] == fast ? launch[6] : 2.0 - launch[6];
		wanted = wanted > SMALLEST ? wanted : SMALLEST;
	}
	let last = 0.0;
	let xi = 1.0;
	let was = error_of(branch, last, s, wanted, f);
	let error = error_of(branch, xi, s, wanted, f);
	let beyond = 0.0;
	if (was * error > 0.0) {
		xi = Math.abs(was) < Math.abs(error) ? last : xi;
		beyond = ahead == 0 && xi == 1.0 ? error : 0.0;
		error = 0.0;
	}
	let n = 0;
	while (n < 60 && Math.abs(error) > 0.001 * TOLERANCE) {
		let now = xi - (xi - last) * (error / (error - was));
		let here = error_of(branch, now, s, wanted, f);
		if (here * error < 0.0) {
			last = xi;
			was = error;
		} else {
			was = 0.5 * was;
		}
		xi = now;
		error = here;
		n = n + 1;
	}
	limit_motion_at(branch, xi, s, f);
	let end = ahead == 1 ? 2 : fast;
	let rate = constant(3 + end, s);
	let theta = (heading_of(xi) + beyond) / rate;
	theta = ahead == 1 ? -theta : theta;
	launch[11] = fast;
	launch[10] = theta;
	launch[9] = 0.0;
	launch[12] = heading_at(end, theta, rate, delta, s, f[1]);
	launch[13] = time;
}
const arrive_o = new Float64Array(2);
function arrive(launch, delta, log_left, place, f) {
	const o = arrive_o;
	let s = STEEP * delta * delta - 1.0;
	let theta = launch[10] + log_left;
	let fast = Math.floor(launch[11]);
	let ahead = theta < 0.0 ? 1 : 0;
	let end = ahead == 1 ? 2 : fast;
	let rate = constant(3 + end, s);
	let z = Math.abs(theta) * rate;
	let heading = z / REACH;
	let xi = 0.5 * (Math.sqrt(heading * (heading + 4.0)) - heading) / END;
	limit_motion_at(2 * fast + ahead, xi < 1.0 ? xi : 1.0, s, o);
	let c = constant(0, s) + o[0];
	let share = 1.0 - Math.abs(c);
	let side = c > 0.0 ? 1 : 0;
	if (ahead == 0) {
		share = o[0] * Math.exp(-z);
		side = share <= 1.0 ? fast : 1 - fast;
		share = share <= 1.0 ? share : 2.0 - share;
	}
	if (share < 0.0) share = 0.0;
	place[0] = side;
	place[1] = share;
	place[2] = heading_at(end, theta, rate, delta, s, o[1]);
	stop_functions(side, share, delta, f);
}
/* How far the heading turns until Q has fallen to 1/1000, rad, into out[1].

For delta > 0 it turns on without end.  The launch is that of stop(), the error the tolerance in
rad, the code as there. */
const turn_launch = new Float64Array(14);
const turn_g = new Float64Array(5);
const turn_place = new Float64Array(3);
function turn(vx, vy, spin, delta, decel, radius, out) {
	const launch = turn_launch;
	const g = turn_g;
	const place = turn_place;
	let code = measured(vx, vy, spin, delta, decel, radius, launch);
	if (code != 0) return refused(out, 1, code);
	out[0] = 0.0;
	if (launch[1] == 0.0 || launch[2] == 0.0 || delta == 0.0) return 0;
	stop_functions(Math.floor(launch[5]), launch[6], delta, g);
	know(delta, g[0], launch);
	let left = TURN_SHARE;
	for (let unused = 0; unused < 12; unused++) {
		arrive(launch, delta, Math.log(left), place, g);
		left = TURN_SHARE * g[0] / launch[13];
	}
	let heading = launch[9] * Math.log(TURN_SHARE) + place[2] - launch[12];
	out[0] = launch[7] * heading;
	return 0;
}
/* Place x m, y m, body angle rad, velocity vx, vy m/s and spin rad/s at a time, into out[6].

The launch is that of stop(); time s >= 0 after it, at rest from the stop on.  Errors: the
tolerance times Q^2/J (place), Q^2/(J r) (angle), Q (velocity) and Q/r (spin) of the launch.
Returns 0, 1 or 2 as stop() does. */
const state_launch = new Float64Array(14);
const state_f = new Float64Array(5);
const state_g = new Float64Array(5);
const state_end = new Float64Array(5);
const state_place = new Float64Array(3);
function state(vx, vy, spin, delta, decel, radius, time, out) {
	const launch = state_launch;
	const f = state_f;
	const g = state_g;
	const end = state_end;
	const place = state_place;
	let code = measured(vx, vy, spin, delta, decel, radius, launch);
	if (!(time - time == 0.0 && time >= 0.0)) code = 1;
	if (code != 0) return refused(out, 6, code);
	stop_functions(Math.floor(launch[5]), launch[6], delta, f);
	stopped(launch, f, delta, decel, radius, end);
	let left = time < end[0] ? 1.0 - time / end[0] : 0.0;
	if (left == 0.0 || launch[1] == 0.0 || launch[2] == 0.0 || time == 0.0) {
		let done = (1.0 - left) * (1.0 + left);
		out[0] = end[1] * done;
		out[1] = end[2] * done;
		out[2] = end[4] * done;
		out[3] = left * vx;
		out[4] = left * vy;
		out[5] = left * spin;
		return 0;
	}
	let slip = launch[0];
	let around = launch[7];
	let size = slip / decel * slip;
	know(delta, f[0], launch);
	arrive(launch, delta, Math.log1p(-(time / end[0])), place, g);
	let fall = left * launch[13] / g[0];
	let small = 0.5 * place[1];
	let large = 1.0 - small;
	let unit = fall / Math.sqrt(small * small + large * large);
	let now = unit * (place[0] == 1.0 ? small : large);
	let turn = unit * (place[0] == 1.0 ? large : small);
	let heading = 0.0;
	if (delta > 0.0) heading = around * (launch[9] * Math.log(fall) + place[2] - launch[12]);
	let cosine = Math.cos(heading);
	let sine = Math.sin(heading);
	let east = (cosine * launch[3] - sine * launch[4]) / launch[1];
	let north = (cosine * launch[4] + sine * launch[3]) / launch[1];
	let ahead = size * fall * now * g[1];
	let aside = size * around * delta * turn * now * g[2];
	out[0] = end[1] - (ahead * east - aside * north);
	out[1] = end[2] - (ahead * north + aside * east);
	out[2] = end[4] - size / radius * around * fall * turn * g[4];
	out[3] = slip * now * east;
	out[4] = slip * now * north;
	out[5] = slip / radius * around * turn;
	return 0;
}
function shape_integrals(ratio, fast, p) {
	let c = (1.0 - ratio) / (1.0 + ratio);
	look_up_near(PATCH, PATCH_ROWS, 5, 1, 3, PATCH_QUANTUM, fast ? c : -c, 0.0, p);
}
/* rho_parallel, rho_perpendicular and rho_omega, into out[3].

phi = atan2(r w, v) from -pi/2 to pi/2, delta = 2 f h / r from 0 to TALLEST.  Force on the puck
-f N cos(phi) rho_parallel along its velocity and -f N sin(phi) cos(phi) rho_perpendicular to
its left, torque -(f N r / 2) sin(phi) rho_omega.  Returns 0, or 1 and NaN where an argument is
not in its range. */
const resultants_p = new Float64Array(3);
function resultants(phi, delta, out) {
	const p = resultants_p;
	if (!(Math.abs(phi) <= HALF_PI && delta >= 0.0 && delta <= TALLEST)) return refused(out, 3, 1);
	let cosine = Math.abs(Math.cos(phi));
	let sine = Math.abs(Math.sin(phi));
	let fast = sine > cosine;
	shape_integrals(fast ? cosine / sine : sine / cosine, fast, p);
	let cos2 = cosine * cosine;
	let sin2 = sine * sine;
	let share = delta / TALLEST;
	let d2 = share * share;
	let parallel = p[0] / (1.0 - d2 * sin2 * p[1] * (p[1] - p[2]));
	out[0] = parallel;
	out[1] = share * parallel * p[1];
	out[2] = 2.0 * (p[2] + d2 * cos2 * parallel * p[1] * (p[2] - 2.0 * p[1]));
	return 0;
}
function misses(got, wanted, unit) {
	return Math.abs(got - wanted) <= TOLERANCE * unit + 1e-300 ? 0 : 1;
}
const resultants_misses_out = new Float64Array(3);
function resultants_misses() {
	let c = RESULTANTS_CASES;
	const out = resultants_misses_out;
	let missed = 0;
	for (let n = 0; n < 10; n++) {
		let k = n * 5;
		missed += resultants(c[k], c[k + 1], out);
		for (let j = 0; j < 3; j++) missed += misses(out[j], c[k + 2 + j], 1.0);
	}
	return missed;
}
const turn_misses_out = new Float64Array(1);
function turn_misses() {
	let c = TURN_CASES;
	const out = turn_misses_out;
	let missed = 0;
	for (let n = 0; n < 3; n++) {
		let k = n * 7;
		missed += turn(c[k], c[k + 1], c[k + 2], c[k + 3], c[k + 4], c[k + 5], out);
		for (let j = 0; j < 1; j++) missed += misses(out[j], c[k + 6 + j], 1.0);
	}
	return missed;
}
function stop_unit(c, k, j) {
	let edge = c[k + 5] * c[k + 2];
	let slip = Math.sqrt(c[k] * c[k] + c[k + 1] * c[k + 1] + edge * edge);
	let unit = slip / c[k + 4] * (j == 0 ? 1.0 : slip);
	return j == 4 ? unit / c[k + 5] : unit;
}
const stop_misses_out = new Float64Array(5);
function stop_misses() {
	let c = STOP_CASES;
	const out = stop_misses_out;
	let missed = 0;
	for (let n = 0; n < 12; n++) {
		let k = n * 11;
		missed += stop(c[k], c[k + 1], c[k + 2], c[k + 3], c[k + 4], c[k + 5], out);
		for (let j = 0; j < 5; j++) missed += misses(out[j], c[k + 6 + j], stop_unit(c, k, j));
	}
	return missed;
}
function state_unit(c, k, j) {
	let unit = j < 3 ? stop_unit(c, k, 1) : stop_unit(c, k, 0) * c[k + 4];
	return j == 2 || j == 5 ? unit / c[k + 5] : unit;
}
const state_misses_out = new Float64Array(6);
function state_misses() {
	let c = STATE_CASES;
	const out = state_misses_out;
	let missed = 0;
	for (let n = 0; n < 13; n++) {
		let k = n * 13;
		missed += state(c[k], c[k + 1], c[k + 2], c[k + 3], c[k + 4], c[k + 5], c[k + 6], out);
		for (let j = 0; j < 6; j++) missed += misses(out[j], c[k + 7 + j], state_unit(c, k, j));
	}
	return missed;
}
/* How many numbers of the test vectors are missed: 0. */
function self_test() {
	return stop_misses() + state_misses() + turn_misses() + resultants_misses();
}
globalThis.puckTables = { stop, state, turn, resultants, self_test };
if (typeof module === "object") module.exports = { stop, state, turn, resultants, self_test };
})();
