import sys,re,glob,math,bisect
from collections import defaultdict
def load(f):
    d=defaultdict(dict)
    for l in open(f):
        p=l.split(); d[int(p[1])][round(float(p[2]))]=(float(p[3]),float(p[4]),int(p[5]),int(p[6]))
    return d
for e in sys.argv[1:]:
    n=e.split('/')[-1].split('-'); cyc=load(f'/tmp/x/cyc/{n[0]}-{n[1]}.cyc')
    ok=bad=refl=miss=0; tried=set(); joined=set(); bads=[]; gaps=[]; c=defaultdict(int); slip=0
    for l in open(e):
        if not l.startswith('JOIN'): continue
        p=l.split(); j=int(p[1]); s=int(p[2]); t0,t1,t2=map(float,p[3:6]); n1,n2=float(p[15]),float(p[16])
        key=(s,t0,t1); tried.add(key)
        if not j: continue
        joined.add(key)
        a=cyc[s].get(round(t0)); b=cyc[s].get(round(t2))
        if a is None or b is None: miss+=1; continue
        if not(a[2] and b[2]): refl+=1
        d1,d2=b[0]-a[0],b[1]-a[1]
        good = (d1==n1 and d2==n2) or (-d1==n1 and -d2==n2)
        gaps.append(t1-t0)
        if good and a[2] and b[2]: ok+=1
        else: bad+=1; bads.append((s,t0,t1,t2,n1-d1,n2-d2,a[2],b[2],' '.join(p[6:])))
    print(e.split('/')[-1],'tried',len(tried),'joined',len(joined),'right',ok,'wrong',bad,'of which reflected',refl,'unknown',miss, 'gap mean %.1f max %.0f'%(sum(gaps)/max(1,len(gaps)),max(gaps or [0])))
    for b in bads[:6]: print('   ',b)
